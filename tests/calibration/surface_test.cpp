#include "calibration/surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "calibration/plane_fit.h"
#include "tests/fakes/scripted_tracker.h"

namespace fude {
namespace {

// An A3 sheet that lies obliquely before the tracker, bowed or flat; millimetres on it as on paper.
struct ScriptedSheet {
  std::function<double(double, double)> height_mm = [](double, double) { return 0.0; };
  double noise_mm = 0.3;
  int across = 5, down = 5;
  double width_mm = 420, height = 297;
  Eigen::Vector3d tip_m{0.004, 0.16, -0.01};
  Pose<Tracker, Paper> tracker_from_paper{
      // metres on both sides
      Eigen::Quaterniond(Eigen::AngleAxisd(2.2, Eigen::Vector3d(1, 0.3, 0.2).normalized())),
      {0.1, -0.2, -1.2}};

  Eigen::Vector3d point_m(double x, double y, double above = 0) const {
    return tracker_from_paper * (1e-3 * Eigen::Vector3d(x, y, height_mm(x, y) + above));
  }

  // The brush stands about upright; the tip rests for 0.3 s at every place and goes through the air between.
  std::vector<PoseSample> samples(std::uint32_t seed) const {
    std::vector<Eigen::Vector2d> places{{0, 0}, {width_mm, 0}, {width_mm, height}, {0, height}};
    for (int i = 0; i < across; ++i)
      for (int j = 0; j < down; ++j) {
        const bool corner = (i == 0 || i == across - 1) && (j == 0 || j == down - 1);
        if (!corner) places.emplace_back(width_mm * i / (across - 1), height * j / (down - 1));
      }
    Noise noise(seed);
    std::vector<PoseSample> all;
    double t = 0;
    for (std::size_t k = 0; k < places.size(); ++k) {
      const double off = noise.normal(noise_mm);
      for (int i = 0; i < 15; ++i, t += 0.02)
        all.push_back(holding(point_m(places[k].x(), places[k].y(), off + noise.normal(0.02)), noise, t));
      for (int i = 1; i < 15 && k + 1 < places.size(); ++i, t += 0.02) {
        const double share = i / 15.0;
        const Eigen::Vector2d at = places[k] + share * (places[k + 1] - places[k]);
        all.push_back(holding(point_m(at.x(), at.y(), 60 * std::sin(share * std::numbers::pi)), noise, t));
      }
    }
    return all;
  }

  PoseSample holding(const Eigen::Vector3d& tip, Noise& noise, double t) const {
    // Paper's z up the handle, which the tip_m of the tool points against.
    const Eigen::Quaterniond upright = Eigen::Quaterniond::FromTwoVectors(tip_m, Eigen::Vector3d(0, 0, -1));
    const Eigen::Vector3d lean = noise.vector(0.1);
    const Eigen::Quaterniond q = tracker_from_paper.rotation *
                                 Eigen::Quaterniond(Eigen::AngleAxisd(lean.norm(), lean.normalized())) *
                                 upright;
    return pose_sample({q, tip - q * tip_m}, t);
  }

  double rms_against_truth_mm(const SurfaceCalibration& found) const {
    double sum = 0;
    int n = 0;
    for (double x = 0; x <= width_mm; x += width_mm / 30)
      for (double y = 0; y <= height; y += height / 20, ++n)
        sum += std::pow(on_paper(found, point_m(x, y)).z(), 2);
    return std::sqrt(sum / n);
  }
};

const auto bow = [](double x, double) { return 20 * std::sin(std::numbers::pi * x / 420); };

Calibration<SurfaceCalibration> surface_of(const std::vector<PoseSample>& samples,
                                           const Eigen::Vector3d& tip_m, bool corners = false) {
  SurfaceProcedure procedure(tip_m, corners);
  for (const PoseSample& s : samples) procedure.add(s);
  return procedure.finish();
}

double mean_rms(const ScriptedSheet& sheet, bool curved) {
  double sum = 0;
  int otherwise = 0;
  constexpr int trials = 40;
  for (std::uint32_t seed = 0; seed < trials; ++seed) {
    const auto found = surface_of(sheet.samples(seed), sheet.tip_m, true);
    EXPECT_TRUE(found) << found.error().reason;
    if (!found) continue;
    otherwise += found->value.sheet.has_value() != curved;
    sum += sheet.rms_against_truth_mm(found->value) / trials;
  }
  EXPECT_LE(otherwise, 2);  // one in forty is what two standard errors allow
  return sum;
}

TEST(Surface, APlaneFromTwentyFiveTouchesOfAThirdOfAMillimetre) {
  const double rms = mean_rms({}, false);
  std::printf("plane, 25 touches of 0.3 mm: %.3f mm RMS against the truth, mean of 40\n", rms);
  EXPECT_LT(rms, 0.15);
}

TEST(Surface, ABowedSheetFromTwentyFiveTouches) {
  const double sine = mean_rms({.height_mm = bow}, true);
  const double parabola =
      mean_rms({.height_mm = [](double x, double) { return 20 - 20 * std::pow((x - 210) / 210, 2); }}, true);
  std::printf("bow of 20 mm, 25 touches of 0.3 mm: %.3f (sine), %.3f (parabola) mm RMS, means of 40\n", sine,
              parabola);
  EXPECT_LT(sine, 0.25);
  EXPECT_LT(parabola, 0.25);
}

// Waves of ±10 mm over A3, of one period and more.
struct Wave {
  const char* name;
  std::function<double(double, double)> height_mm;
};
const Wave waves[] = {
    {"along", [](double x, double) { return 10 * std::sin(2 * std::numbers::pi * x / 420); }},
    {"steep", [](double x, double) { return 10 * std::sin(2 * std::numbers::pi * x / 280); }},
    {"across", [](double, double y) { return 10 * std::sin(2 * std::numbers::pi * y / 297); }},
    {"crossed",
     [](double x, double y) {
       return 10 * std::sin(2 * std::numbers::pi * x / 420) * std::cos(std::numbers::pi * y / 297);
     }},
    {"oblique", [](double x, double y) { return 10 * std::sin(2 * std::numbers::pi * (x + y) / 400); }},
};

TEST(Surface, WavesAreFollowedWhereTheyWereTouchedDensely) {
  constexpr std::uint32_t trials = 6;
  for (const Wave& wave : waves) {
    const ScriptedSheet sheet{.height_mm = wave.height_mm, .across = 9, .down = 8};
    double sum = 0, worst = 0;
    int refused = 0;
    for (std::uint32_t seed = 0; seed < trials; ++seed) {
      const auto found = surface_of(sheet.samples(seed), sheet.tip_m, true);
      refused += !found;
      if (!found) continue;
      const double rms = sheet.rms_against_truth_mm(found->value);
      EXPECT_TRUE(found->value.sheet);
      EXPECT_LT(rms, (*found->report.ci95)[1]) << wave.name;
      sum += rms;
      worst = std::max(worst, rms);
    }
    std::printf(
        "figure: waves of 10 mm %s, 9 x 8 touches of 0.3 mm: %.3f mm RMS, worst %.3f, %d of %u refused\n",
        wave.name, sum / std::max(1.0, double(trials) - refused), worst, refused, trials);
    EXPECT_LE(refused, 1) << wave.name;
    EXPECT_LT(worst, 0.65) << wave.name;
  }
}

TEST(Surface, WavesThatWereTouchedTooSparselyAreRefusedSayingWhere) {
  int accepted = 0, all = 0;
  for (const Wave& wave : waves)
    for (const int across : {5, 6})
      for (std::uint32_t seed = 0; seed < 4; ++seed, ++all) {
        const ScriptedSheet sheet{.height_mm = wave.height_mm, .across = across, .down = 5};
        const auto found = surface_of(sheet.samples(seed), sheet.tip_m, true);
        accepted += found.has_value();
        if (found) {  // then it knows how far off it may be
          EXPECT_LT(sheet.rms_against_truth_mm(found->value), (*found->report.ci95)[1]) << wave.name;
          EXPECT_FALSE(found->report.warnings.empty()) << wave.name;
        } else {
          EXPECT_NE(found.error().reason.find("wav"), std::string::npos) << found.error().reason;
        }
      }
  std::printf("figure: waves of 10 mm, 5 x 5 and 6 x 5 touches: %d of %d accepted, with a warning\n",
              accepted, all);
  EXPECT_LE(accepted, all / 10);
}

TEST(Surface, CornersGiveThePaperItsMillimetres) {
  const ScriptedSheet sheet{.noise_mm = 0};
  const auto found = surface_of(sheet.samples(1), sheet.tip_m, true);
  ASSERT_TRUE(found) << found.error().reason;
  EXPECT_NEAR(found->value.width_mm, 420, 0.1);
  EXPECT_NEAR(found->value.height_mm, 297, 0.1);
  for (const auto& [x, y] : {std::pair(0.0, 0.0), std::pair(420.0, 297.0), std::pair(100.0, 50.0)})
    EXPECT_LT((on_paper(found->value, sheet.point_m(x, y, 7)) - Eigen::Vector3d(x, y, 7)).norm(), 0.15);
}

TEST(Surface, WithoutCornersUpIsWhereTheHandleIs) {
  const ScriptedSheet sheet{.noise_mm = 0.1};
  const auto found = surface_of(sheet.samples(2), sheet.tip_m);
  ASSERT_TRUE(found) << found.error().reason;
  EXPECT_NEAR(on_paper(found->value, sheet.point_m(200, 150, 30)).z(), 30, 0.3);
  EXPECT_NEAR(found->value.width_mm, 420, 1);
  EXPECT_FALSE(found->report.warnings.empty());
}

TEST(Surface, CornersInTheWrongOrderAreRefused) {
  const ScriptedSheet sheet;
  auto samples = sheet.samples(1);
  std::vector<PoseSample> backwards;
  double t = 0;
  Noise noise(4);
  for (const auto& [x, y] :
       {std::pair(0.0, 0.0), std::pair(0.0, 297.0), std::pair(420.0, 297.0), std::pair(420.0, 0.0),
        std::pair(200.0, 100.0), std::pair(50.0, 120.0), std::pair(300.0, 220.0)})
    for (int i = 0; i < 15; ++i, t += 0.02) backwards.push_back(sheet.holding(sheet.point_m(x, y), noise, t));
  const auto found = surface_of(backwards, sheet.tip_m, true);
  ASSERT_FALSE(found);
  EXPECT_NE(found.error().reason.find("out of order"), std::string::npos) << found.error().reason;
}

TEST(Surface, WipingCountsWhatLiesOnTheSheet) {
  const ScriptedSheet sheet{.height_mm = bow};
  Noise noise(5);
  std::vector<PoseSample> wiped;
  for (int i = 0; i < 2000; ++i) {
    const double t = i / 100.0;
    const double lifted = i % 200 < 40 ? 3 + 2 * (i % 40) : 0;  // a fifth of the way through the air
    wiped.push_back(sheet.holding(sheet.point_m(210 + 205 * std::sin(1.7 * t), 148 + 140 * std::sin(2.9 * t),
                                                lifted + noise.normal(0.3)),
                                  noise, t));
  }
  const auto found = surface_of(wiped, sheet.tip_m);
  ASSERT_TRUE(found) << found.error().reason;
  ASSERT_TRUE(found->value.sheet);
  EXPECT_LT(sheet.rms_against_truth_mm(found->value), 0.25);
}

TEST(Surface, WhereAWipingTipNeverWasIsNamed) {
  const ScriptedSheet sheet{.height_mm = bow};
  Noise noise(5);
  std::vector<PoseSample> wiped;
  for (int i = 0; i < 2000; ++i) {
    const double t = i / 100.0, round = 0.05 + 0.95 * std::abs(std::sin(0.37 * t));
    wiped.push_back(sheet.holding(sheet.point_m(210 + 205 * round * std::sin(1.7 * t),
                                                148 + 140 * round * std::cos(1.7 * t), noise.normal(0.3)),
                                  noise, t));
  }
  const auto found = surface_of(wiped, sheet.tip_m);
  ASSERT_TRUE(found) << found.error().reason;
  const auto& warnings = found->report.warnings;
  const auto named = std::ranges::find_if(
      warnings, [](const std::string& w) { return w.find("the tip never was at") != std::string::npos; });
  ASSERT_NE(named, warnings.end());
  for (const char* part : {"lower left", "lower right", "upper left", "upper right"})
    EXPECT_NE(named->find(part), std::string::npos) << *named;
  EXPECT_EQ(named->find("middle"), std::string::npos) << *named;
}

TEST(Surface, ATouchBesideTheSheetIsNamed) {
  const ScriptedSheet sheet;
  auto samples = sheet.samples(6);
  for (std::size_t i = 0; i < 15; ++i)  // the tenth touch, 8 mm above
    samples[9 * 29 + i].tracker_from_tool.translation +=
        sheet.tracker_from_paper.rotation * Eigen::Vector3d(0, 0, 0.008);
  const auto found = surface_of(samples, sheet.tip_m);
  ASSERT_TRUE(found) << found.error().reason;
  EXPECT_LT(sheet.rms_against_truth_mm(found->value), 0.3);
  for (const Field& field : found->report.details)
    if (field.key == "outliers") {
      const auto& names = std::get<std::vector<std::string>>(field.value);
      ASSERT_EQ(names.size(), 1U) << names[1];
      EXPECT_TRUE(names[0].starts_with("touch 9 at 5.2")) << names[0];
    }
}

TEST(Surface, ContactsFindItsHeightAndNormal) {
  const ScriptedSheet sheet{.height_mm = bow, .noise_mm = 0};
  const auto found = surface_of(sheet.samples(3), sheet.tip_m, true);
  ASSERT_TRUE(found) << found.error().reason;
  for (const auto& [x, y] : {std::pair(77.0, 88.0), std::pair(210.0, 150.0), std::pair(390.0, 20.0)}) {
    const Eigen::Vector3d tracker_mm = 1e3 * sheet.point_m(x, y);
    const Eigen::Vector3d paper = found->value.paper_from_tracker * tracker_mm;
    const SheetPoint at = sheet_at(found->value, paper.head<2>());
    EXPECT_NEAR(at.height_mm, paper.z(), 0.2);
    const double slope = 20 * std::numbers::pi / 420 * std::cos(std::numbers::pi * x / 420);
    const Eigen::Vector3d normal =
        sheet.tracker_from_paper.rotation * Eigen::Vector3d(-slope, 0, 1).normalized();
    EXPECT_LT((found->value.paper_from_tracker.rotation * normal - at.normal).norm(), 0.02);
  }
  EXPECT_EQ(sheet_at({}, {3, 4}).normal, Eigen::Vector3d::UnitZ());
}

TEST(Surface, ResultsReadBack) {
  const ScriptedSheet sheet{.height_mm = bow};
  const auto found = surface_of(sheet.samples(3), sheet.tip_m, true);
  ASSERT_TRUE(found);
  const auto read = surface_from(to_fields(found->value));
  ASSERT_TRUE(read);
  const Eigen::Vector3d p = sheet.point_m(77, 88, 3);
  EXPECT_LT((on_paper(*read, p) - on_paper(found->value, p)).norm(), 1e-9);
  EXPECT_FALSE(surface_from({{"shape", std::string("plane")}}));
}

void expect_refused(const std::vector<PoseSample>& samples, const std::string& cause) {
  const auto found = surface_of(samples, ScriptedSheet{}.tip_m);
  ASSERT_FALSE(found) << "accepted, where it should name: " << cause;
  EXPECT_NE(found.error().reason.find(cause), std::string::npos) << found.error().reason;
}

TEST(SurfaceRefuses, TooFewDuplicatedFrozenAndCollinearTouches) {
  const ScriptedSheet sheet{.noise_mm = 0};
  const auto samples = sheet.samples(1);
  expect_refused({}, "places");
  expect_refused({samples.begin(), samples.begin() + 15}, "different places");
  std::vector<PoseSample> frozen(100, samples[0]);
  expect_refused(frozen, "frozen");
  Noise noise(8);
  std::vector<PoseSample> line;
  for (int i = 0; i < 300; ++i)
    line.push_back(sheet.holding(sheet.point_m(20.0 * (i / 15), 30), noise, 0.02 * i));
  expect_refused(line, "one line");
}

TEST(SurfaceRefuses, ATipThatWasSeldomOnOneSurface) {
  Noise noise(9);
  const ScriptedSheet sheet;
  std::vector<PoseSample> air;
  for (int i = 0; i < 600; ++i)
    air.push_back(sheet.holding(
        sheet.point_m(noise.uniform(0, 400), noise.uniform(0, 290), noise.uniform(0, 200)), noise, 0.02 * i));
  const auto found = surface_of(air, sheet.tip_m);
  ASSERT_FALSE(found);
  EXPECT_FALSE(found.error().reason.empty());
}

TEST(SurfaceSurvives, NumbersThatAreNone) {
  const ScriptedSheet sheet;
  auto samples = sheet.samples(1);
  for (std::size_t i = 0; i < samples.size(); i += 17)
    samples[i].tracker_from_tool.translation.z() = std::numeric_limits<double>::quiet_NaN();
  const auto found = surface_of(samples, sheet.tip_m);
  ASSERT_TRUE(found) << found.error().reason;
  EXPECT_LT(sheet.rms_against_truth_mm(found->value), 0.3);
}

TEST(Surface, ProgressCountsThePlacesWhereTheTipRested) {
  const ScriptedSheet script;
  const auto samples = script.samples(5);
  SurfaceProcedure touched(script.tip_m), wiped(script.tip_m);
  Progress half, whole, never;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    whole = touched.add(samples[i]);
    if (i == samples.size() / 2) half = whole;
    if (i % 29 >= 15) never = wiped.add(samples[i]);  // only in the air
  }
  EXPECT_NEAR(half.covered, 0.5, 0.05);
  EXPECT_FALSE(half.missing.empty());
  EXPECT_EQ(whole.covered, 1);
  EXPECT_TRUE(whole.missing.empty());
  EXPECT_EQ(never.covered, 0);
}

// Four and a half waves by five columns look like half a wave: nothing in the touches tells, but how they
// stand.
TEST(Surface, WavesAsShortAsTheGridAreWarnedOf) {
  const auto warned = [](const Calibration<SurfaceCalibration>& found) {
    return std::ranges::any_of(found->report.warnings, [](const std::string& w) {
      return w.find("touch between the rows too") != std::string::npos;
    });
  };
  const ScriptedSheet cockled{
      .height_mm = [](double x, double) { return 5 * std::cos(4.5 * 2 * std::numbers::pi * x / 420); }};
  const auto aliased = surface_of(cockled.samples(1), cockled.tip_m, true);
  ASSERT_TRUE(aliased) << aliased.error().reason;
  EXPECT_GT(cockled.rms_against_truth_mm(aliased->value), 2);
  EXPECT_TRUE(warned(aliased));

  // The same number of touches, every other column half a row lower: then the waves show.
  SurfaceProcedure procedure(cockled.tip_m);
  ScriptedSheet bowed{.height_mm = bow};
  Noise noise(2);
  double t = 0;
  for (int i = 0; i < 9; ++i)
    for (int j = 0; j < 5; ++j)
      for (int k = 0; k < 15; ++k, t += 0.02)
        procedure.add(bowed.holding(
            bowed.point_m(52.5 * i, std::min(297.0, 59.0 * j + (i % 2 ? 30 : 0)), noise.normal(0.02)), noise,
            t));
  const auto staggered = procedure.finish();
  ASSERT_TRUE(staggered) << staggered.error().reason;
  EXPECT_TRUE(staggered->value.sheet);
  EXPECT_FALSE(warned(staggered));
}

// Who touches row by row has not done when 25 places are touched, but when the upper part is too.
TEST(Surface, TheProgressAsksForThePartsThatTheCornersEnclose) {
  const ScriptedSheet sheet;
  SurfaceProcedure procedure(sheet.tip_m, true);
  Noise noise(3);
  double t = 0;
  const auto touch = [&](double x, double y) {
    Progress progress;
    for (int k = 0; k < 15; ++k, t += 0.02)
      progress = procedure.add(sheet.holding(sheet.point_m(x, y, noise.normal(0.02)), noise, t));
    return progress;
  };
  touch(0, 0), touch(420, 0), touch(420, 297), touch(0, 297);
  Progress progress;
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 8; ++i) progress = touch(30 + 50 * i, 20 + 30 * j);
  EXPECT_LT(progress.covered, 1);
  EXPECT_NE(progress.missing.find("upper middle"), std::string::npos) << progress.missing;
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 8; ++i) progress = touch(30 + 50 * i, 130 + 60 * j);
  EXPECT_EQ(progress.covered, 1) << progress.missing;
}

}  // namespace
}  // namespace fude
