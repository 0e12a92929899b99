#include "calibration/tablet_surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "calibration/tap_fit.h"
#include "tests/fakes/scripted_pen.h"
#include "tests/fakes/scripted_tracker.h"

namespace fude {
namespace {

// A sheet on a tablet of 200 counts a millimetre that lies a little turned and is seen a little obliquely;
// the coil stands 6 mm up the pen.
struct ScriptedTablet {
  double width_mm = 240, height_mm = 150;
  double noise_mm = 0.1;  // of each tap and coordinate
  double bend_mm = 0;
  double turn_rad = 0.03;
  double coil_mm = 6;
  double most_tilt_rad = 0.7;

  Eigen::Vector2d counts(const Eigen::Vector2d& mm, const Eigen::Vector2d& lean) const {
    const Eigen::Vector2d bent(
        mm.x() + bend_mm * std::sin(std::numbers::pi * mm.y() / height_mm) * std::cos(2 * mm.x() / width_mm),
        mm.y() + 0.7 * bend_mm * std::sin(2 * std::numbers::pi * mm.x() / width_mm));
    const Eigen::Vector2d c = bent - 0.5 * Eigen::Vector2d(width_mm, height_mm);
    const double depth = 1 + 1e-4 * c.x() - 2e-4 * c.y();
    const Eigen::Vector2d turned(std::cos(turn_rad) * c.x() + std::sin(turn_rad) * c.y(),
                                 -std::sin(turn_rad) * c.x() + std::cos(turn_rad) * c.y());
    return {26000 + 200 * (turned.x() / depth + coil_mm * lean.x()),
            17000 - 200 * (turned.y() / depth - coil_mm * lean.y())};
  }

  PenSample touching(const Eigen::Vector2d& mm, const Eigen::Vector2d& tilt_rad) const {
    PenSample s = pen_sample(0, counts(mm, {std::tan(tilt_rad.x()), std::tan(tilt_rad.y())}), true);
    s.tilt_x = Radians(tilt_rad.x());
    s.tilt_y = Radians(tilt_rad.y());
    return s;
  }

  PenSample tapped(const Eigen::Vector2d& mm, Noise& noise) const {
    const Eigen::Vector2d tilt(noise.uniform(-most_tilt_rad, most_tilt_rad),
                               noise.uniform(-most_tilt_rad, most_tilt_rad));
    return touching(mm + noise.vector(noise_mm).head<2>(), tilt);
  }

  TapSheet grid(int across, int down) const { return tap_grid(across, down, width_mm, height_mm); }

  std::vector<PenSample> taps(const std::vector<Eigen::Vector2d>& places, std::uint32_t seed) const {
    Noise noise(seed);
    std::vector<PenSample> samples;
    for (const Eigen::Vector2d& place : places) tap(samples, tapped(place, noise));
    return samples;
  }

  double rms_against_truth_mm(const TabletSurface& found) const {
    double sum = 0;
    int n = 0;
    for (double x = 0; x <= width_mm; x += width_mm / 12)
      for (double y = 0; y <= height_mm; y += height_mm / 8)
        for (const Eigen::Vector2d& tilt :
             {Eigen::Vector2d(0.6, -0.2), Eigen::Vector2d(-0.5, 0.3), Eigen::Vector2d(0, 0)}) {
          sum += (on_paper(found, touching({x, y}, tilt)) - Eigen::Vector2d(x, y)).squaredNorm();
          ++n;
        }
    return std::sqrt(sum / n);
  }
};

Calibration<TabletSurface> found_by(const TapSheet& sheet, const std::vector<PenSample>& samples) {
  TabletProcedure procedure(sheet);
  for (const PenSample& s : samples) procedure.add(s);
  return procedure.finish();
}

struct Trials {
  double rms = 0;
  double held_out = 0;
  int bent = 0;
};

Trials trials(const ScriptedTablet& tablet, int across, int down, int count) {
  Trials all;
  for (int seed = 0; seed < count; ++seed) {
    const TapSheet sheet = tablet.grid(across, down);
    const auto found = found_by(sheet, tablet.taps(sheet.places_mm, std::uint32_t(seed)));
    EXPECT_TRUE(found) << found.error().reason;
    if (!found) continue;
    all.rms += tablet.rms_against_truth_mm(found->value) / count;
    all.held_out += *found->report.held_out_rms / count;
    all.bent += found->value.warp.has_value();
  }
  return all;
}

TEST(TabletSurface, NineAndTwentyFiveTapsOfATenthOfAMillimetre) {
  const Trials nine = trials({}, 3, 3, 20), many = trials({}, 5, 5, 6);
  std::printf("figure: tablet, 9 taps of 0.1 mm: %.3f mm RMS against the truth (held out %.3f)\n", nine.rms,
              nine.held_out);
  std::printf("figure: tablet, 25 taps of 0.1 mm: %.3f mm RMS against the truth (held out %.3f)\n", many.rms,
              many.held_out);
  EXPECT_LT(nine.rms, 0.18);
  EXPECT_LT(many.rms, 0.09);
  EXPECT_LE(many.bent, 1);  // two standard errors
}

TEST(TabletSurface, ABentScreenGetsAWarp) {
  const Trials bent = trials({.bend_mm = 2}, 5, 5, 5);
  std::printf(
      "figure: bent tablet (2 mm), 25 taps of 0.1 mm: %.3f mm RMS against the truth (held out %.3f)\n",
      bent.rms, bent.held_out);
  EXPECT_EQ(bent.bent, 5);
  EXPECT_LT(bent.rms, 0.25);
}

TEST(TabletSurface, ExactTapsGiveTheMapExactly) {
  const ScriptedTablet tablet{.noise_mm = 0};
  const TapSheet sheet = tablet.grid(4, 3);
  const auto found = found_by(sheet, tablet.taps(sheet.places_mm, 1));
  ASSERT_TRUE(found) << found.error().reason;
  EXPECT_LT(tablet.rms_against_truth_mm(found->value), 1e-6);
  EXPECT_FALSE(found->value.warp);
  EXPECT_NEAR(found->value.lean_counts.x(), -200 * tablet.coil_mm, 1e-3);
  EXPECT_NEAR(found->value.lean_counts.y(), -200 * tablet.coil_mm, 1e-3);
  EXPECT_NEAR(turn_of(found->value).value, tablet.turn_rad, 0.02);
  EXPECT_EQ(found->value.width_mm, 240);
}

TEST(TabletSurface, WithoutTiltThereIsNoShift) {
  ScriptedTablet tablet{.most_tilt_rad = 0};
  const TapSheet sheet = tablet.grid(3, 3);
  auto samples = tablet.taps(sheet.places_mm, 2);
  for (PenSample& s : samples) s.tilt_x = s.tilt_y = std::nullopt;
  const auto found = found_by(sheet, samples);
  ASSERT_TRUE(found) << found.error().reason;
  EXPECT_EQ(found->value.lean_counts, Eigen::Vector2d(0, 0));
  EXPECT_TRUE(found->report.warnings.empty()) << found->report.warnings[0];
}

TEST(TabletSurface, ABadTapIsNamedAndLeftOut) {
  for (const int side : {4, 5}) {
    const ScriptedTablet tablet;
    const TapSheet sheet = tablet.grid(side, side);
    auto tapped = sheet.places_mm;
    tapped[6] += Eigen::Vector2d(2.5, -3);
    const auto found = found_by(sheet, tablet.taps(tapped, 3));
    ASSERT_TRUE(found) << found.error().reason;
    EXPECT_LT(tablet.rms_against_truth_mm(found->value), 0.25);
    ASSERT_FALSE(found->report.warnings.empty());
    EXPECT_TRUE(found->report.warnings[0].starts_with("left out: tap 7 at ")) << found->report.warnings[0];
  }
}

TEST(TabletSurface, WhatIsStoredGivesTheSameBits) {
  const ScriptedTablet tablet{.bend_mm = 2};
  const TapSheet sheet = tablet.grid(5, 5);
  const auto found = found_by(sheet, tablet.taps(sheet.places_mm, 4));
  ASSERT_TRUE(found && found->value.warp);
  Fields fields = to_fields(found->value);
  const auto read = tablet_surface_from(fields);
  ASSERT_TRUE(read);
  const PenSample pen = tablet.touching({77, 33}, {0.2, -0.4});
  EXPECT_EQ(on_paper(*read, pen), on_paper(found->value, pen));
  std::get<std::vector<double>>(fields[1].value)[4] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(tablet_surface_from(fields));
  EXPECT_FALSE(tablet_surface_from({{"shape", std::string("plane")}}));
}

TEST(TabletSurface, OfCountsFarOffNothingIsInfinite) {
  const ScriptedTablet tablet;
  const TapSheet sheet = tablet.grid(3, 3);
  const auto found = found_by(sheet, tablet.taps(sheet.places_mm, 5));
  ASSERT_TRUE(found);
  for (const double far : {-1e9, -1e5, 0.0, 1e5, 1e9})
    EXPECT_TRUE(on_paper(found->value, {far, -far}, {5.7, 5.7}).allFinite());
}

class TabletRefuses : public testing::Test {
 protected:
  void expect_refused(const std::vector<PenSample>& samples, const std::string& cause) const {
    const auto found = found_by(sheet_, samples);
    ASSERT_FALSE(found) << "accepted, where it should name: " << cause;
    EXPECT_NE(found.error().reason.find(cause), std::string::npos) << found.error().reason;
  }
  std::vector<PenSample> in_order(const std::function<Eigen::Vector2d(int)>& place) const {
    std::vector<Eigen::Vector2d> places;
    for (int i = 0; i < 25; ++i) places.push_back(place(i));
    return tablet_.taps(places, 6);
  }
  ScriptedTablet tablet_;
  TapSheet sheet_ = tablet_.grid(5, 5);
};

TEST_F(TabletRefuses, TapsInAnotherOrderByItsName) {
  expect_refused(in_order([&](int i) { return sheet_.places_mm[std::size_t(5 * (i % 5) + i / 5)]; }),
                 "column by column");
  sheet_ = tablet_.grid(6, 4);
  std::vector<Eigen::Vector2d> by_columns;
  for (std::size_t i = 0; i < 24; ++i) by_columns.push_back(sheet_.places_mm[6 * (i % 4) + i / 4]);
  expect_refused(tablet_.taps(by_columns, 6), "the taps go column by column");
  sheet_ = tablet_.grid(5, 5);
  expect_refused(in_order([&](int i) {
                   return sheet_.places_mm[std::size_t(i / 5 % 2 == 0 ? i : 5 * (i / 5) + 4 - i % 5)];
                 }),
                 "to and fro");
  expect_refused(in_order([&](int i) {
                   return sheet_.places_mm[std::size_t(i == 8 ? 17 : i == 17 ? 8 : i)];
                 }),
                 "taps 9 and 18 are exchanged");
  expect_refused(in_order([&](int i) { return sheet_.places_mm[std::size_t(5 * (i / 5) + 4 - i % 5)]; }),
                 "mirrored");
  expect_refused(in_order([&](int i) { return sheet_.places_mm[std::size_t(7 * i % 25)]; }), "another order");
}

TEST_F(TabletRefuses, TooFewTooManyAndRepeatedTaps) {
  expect_refused({}, "0 taps for 25 places");
  auto places = sheet_.places_mm;
  places.pop_back();
  expect_refused(tablet_.taps(places, 7), "24 taps for 25 places");
  places.insert(places.begin() + 4, places[4]);
  places.push_back(sheet_.places_mm.back());
  expect_refused(tablet_.taps(places, 7), "taps 5 and 6 are on one place");
  places.pop_back();
  expect_refused(tablet_.taps(places, 7), "taps 5 and 6 are on one place");
}

TEST_F(TabletRefuses, AFrozenTabletAndOneWhoseAxisIs) {
  const PenSample one = tablet_.touching({30, 30}, {0, 0});
  std::vector<PenSample> samples;
  for (int i = 0; i < 25; ++i) tap(samples, one);
  expect_refused(samples, "frozen");
  samples = tablet_.taps(sheet_.places_mm, 8);
  for (PenSample& s : samples) s.y_counts = s.x_counts;
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i].x_counts += double(i);
  expect_refused(samples, "one line");
}

TEST_F(TabletRefuses, AListThatCannotDo) {
  const auto samples = tablet_.taps(sheet_.places_mm, 9);
  sheet_ = tablet_.grid(2, 4);
  expect_refused(samples, "nine are the fewest");
  sheet_ = tablet_.grid(5, 5);
  for (Eigen::Vector2d& place : sheet_.places_mm) place.y() = 0.5 * place.x();
  expect_refused(samples, "are the same");
  for (std::size_t i = 0; i < 25; ++i) sheet_.places_mm[i] = Eigen::Vector2d(double(i), 2 * double(i));
  expect_refused(samples, "all places lie on one line");
}

TEST_F(TabletRefuses, StrokesInsteadOfTaps) {
  auto samples = tablet_.taps(sheet_.places_mm, 10);
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i].x_counts += 60 * double(i % 50);
  expect_refused(samples, "did not rest");
}

TEST(TabletSurvives, BouncesAndNumbersThatAreNone) {
  const ScriptedTablet tablet;
  const TapSheet sheet = tablet.grid(5, 5);
  auto samples = tablet.taps(sheet.places_mm, 12);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (i % 50 == 15) samples[i].in_contact = false;  // a bounce of 10 ms
    if (i % 50 == 2) samples[i].in_contact = true;    // a brush in passing
    if (i % 17 == 0) samples[i].x_counts = std::numeric_limits<double>::quiet_NaN();
  }
  const auto found = found_by(sheet, samples);
  ASSERT_TRUE(found) << found.error().reason;
  EXPECT_LT(tablet.rms_against_truth_mm(found->value), 0.15);
}

TEST(TabletSurface, ItSaysWhatToTapNext) {
  const ScriptedTablet tablet;
  const TapSheet sheet = tablet.grid(3, 3);
  TabletProcedure procedure(sheet);
  EXPECT_EQ(procedure.add(pen_sample(0, {0, 0}, false)).missing, "tap place 1 of 9, at (0, 150) mm");
  Progress last;
  for (const PenSample& s : tablet.taps(sheet.places_mm, 1)) last = procedure.add(s);
  EXPECT_EQ(last.covered, 1);
  EXPECT_TRUE(last.missing.empty());
}

}  // namespace
}  // namespace fude
