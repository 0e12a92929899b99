// A rig that was moved by known ways, and what three touches say of it.
#include "calibration/rig_check.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/fakes/scripted_tracker.h"

namespace fude {
namespace {

// An A4 sheet that stands anyhow in the tracker's frame, and a brush that touches its corners.
struct Rig {
  Eigen::Vector3d tip_m{0.01, 0.002, -0.15};
  Eigen::Vector3d true_tip_m = tip_m;
  Pose<Paper, Paper> now_from_then;  // of the paper, mm
  double lean_rad = 0.6;             // differs from touch to touch
  double noise_mm = 0.2;
  bool corners = true;

  static SurfaceCalibration surface() {
    SurfaceCalibration surface;
    surface.paper_from_tracker = {
        Eigen::Quaterniond(Eigen::AngleAxisd(2, Eigen::Vector3d(1, -2, 0.5).normalized())),
        Eigen::Vector3d(150, -80, 900)};
    surface.width_mm = 297;
    surface.height_mm = 210;
    return surface;
  }

  Calibration<RigCheck> checked(const std::vector<Eigen::Vector2d>& places = {{0, 0}, {297, 0}, {297, 210}},
                                std::uint32_t seed = 3) const {
    Noise noise(seed);
    RigCheckProcedure procedure(surface(), tip_m, corners);
    const auto tracker_from_paper = surface().paper_from_tracker.inverse();
    double t = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const Eigen::Vector3d aimed =
          now_from_then * Eigen::Vector3d(places[i].x(), places[i].y(), 0) + noise.vector(noise_mm);
      const Eigen::Vector3d at_m = 1e-3 * (tracker_from_paper * aimed);
      const double way = 2.1 * double(i);
      const Eigen::Quaterniond turned =
          tracker_from_paper.rotation *
          Eigen::Quaterniond(Eigen::AngleAxisd(lean_rad, Eigen::Vector3d(std::cos(way), std::sin(way), 0)));
      for (int n = 0; n < 40; ++n, t += 0.01)
        procedure.add(pose_sample({turned, at_m - turned * true_tip_m + noise.vector(2e-5)}, t));
    }
    return procedure.finish();
  }
};

Pose<Paper, Paper> moved(double right, double up, double off, double turned_deg = 0) {
  const Eigen::Quaterniond turn(
      Eigen::AngleAxisd(turned_deg * std::numbers::pi / 180, Eigen::Vector3d::UnitZ()));
  const Eigen::Vector3d middle(148.5, 105, 0);
  return {turn, middle + Eigen::Vector3d(right, up, off) - turn * middle};
}

double detail(const CalibrationReport& report, const char* key) {
  const auto numbers = numbers_in(report.details, key);
  EXPECT_TRUE(numbers) << key;
  return numbers ? numbers->front() : 0;
}

TEST(RigCheck, ARigThatStayedPasses) {
  const auto found = Rig().checked();
  ASSERT_TRUE(found) << found.error().reason;
  EXPECT_EQ(found->value.moved, RigMoved::nothing);
  EXPECT_LT(found->report.max, 1);
}

TEST(RigCheck, APaperThatWasPushedAndTurned) {
  Rig rig;
  rig.now_from_then = moved(12, -3, 0.5, 1.5);
  const auto found = rig.checked();
  ASSERT_FALSE(found);
  const CalibrationReport& report = found.error();
  EXPECT_EQ(text_in(report.details, "moved"), "paper");
  EXPECT_NEAR(detail(report, "paper_right_mm"), 12, 0.5);
  EXPECT_NEAR(detail(report, "paper_up_mm"), -3, 0.5);
  EXPECT_NEAR(detail(report, "paper_off_mm"), 0.5, 0.5);
  EXPECT_NEAR(detail(report, "paper_turned_deg"), 1.5, 0.2);
  EXPECT_NE(report.reason.find("to the right"), std::string::npos) << report.reason;
}

TEST(RigCheck, ATipThatSlipped) {
  Rig rig;
  rig.true_tip_m += Eigen::Vector3d(0.002, -0.001, -0.006);
  const auto found = rig.checked();
  ASSERT_FALSE(found);
  EXPECT_EQ(text_in(found.error().details, "moved"), "tip") << found.error().reason;
  const auto tip = numbers_in(found.error().details, "tip_moved_mm");
  ASSERT_TRUE(tip);
  EXPECT_LT((Eigen::Vector3d(tip->data()) - Eigen::Vector3d(2, -1, -6)).norm(), 0.5);
}

TEST(RigCheck, ABrushThatIsHeldTheSameWayCannotTellWhich) {
  Rig rig;
  rig.lean_rad = 0;
  rig.now_from_then = moved(4, 0, 0);
  const auto found = rig.checked();
  ASSERT_FALSE(found);
  EXPECT_EQ(text_in(found.error().details, "moved"), "unclear");
  EXPECT_NE(found.error().reason.find("cannot be told which"), std::string::npos) << found.error().reason;
}

TEST(RigCheck, BothThatMovedAreNotOneThatDid) {
  Rig rig;
  rig.true_tip_m += Eigen::Vector3d(0.008, 0.006, 0);
  rig.now_from_then = moved(0, 10, 3);
  const auto found = rig.checked();
  ASSERT_FALSE(found);
  EXPECT_EQ(text_in(found.error().details, "moved"), "unclear");
  EXPECT_NE(found.error().reason.find("neither"), std::string::npos) << found.error().reason;
}

TEST(RigCheck, AwayFromTheCornersTheHeightAloneIsKnown) {
  const std::vector<Eigen::Vector2d> inside{{100, 90}, {200, 80}, {150, 120}};
  Rig rig;
  rig.now_from_then = moved(20, 0, 0);
  const auto along = rig.checked(inside);
  ASSERT_TRUE(along) << along.error().reason;
  EXPECT_EQ(along->report.warnings.size(), 1U);
  rig.now_from_then = moved(0, 0, 5);
  const auto above = rig.checked(inside);
  ASSERT_FALSE(above);
  EXPECT_NEAR(above.error().max, 5, 0.7);
  // Corners that were never touched are not the paper's.
  rig.corners = false;
  EXPECT_EQ(rig.checked().error().warnings.size(), 1U);
}

TEST(RigCheck, ARestElsewhereDoesNotCount) {
  const auto found = Rig().checked({{150, -400}, {0, 0}, {297, 0}, {140, 100}, {297, 210}});
  ASSERT_TRUE(found) << found.error().reason;
  EXPECT_EQ(found->report.n, 3U);
  EXPECT_TRUE(found->value.paper);
}

TEST(RigCheck, TooFewTouchesAreNamed) {
  const auto found = Rig().checked({{0, 0}, {297, 0}});
  ASSERT_FALSE(found);
  EXPECT_NE(found.error().reason.find("rested at 2 places"), std::string::npos) << found.error().reason;
}

// Of a hundred rigs each, none is told wrongly: a paper is never called a tip, nor a tip a paper.
TEST(RigCheck, NeitherIsTakenForTheOther) {
  int papers = 0, tips = 0;
  for (std::uint32_t seed = 1; seed <= 100; ++seed) {
    Noise noise(seed);
    Rig paper, tip;
    paper.now_from_then =
        moved(noise.uniform(-10, 10), noise.uniform(-10, 10), noise.uniform(-3, 3), noise.uniform(-2, 2));
    tip.true_tip_m +=
        1e-3 * Eigen::Vector3d(noise.uniform(-6, 6), noise.uniform(-6, 6), noise.uniform(-6, 6));
    const std::vector<Eigen::Vector2d> places{{0, 0}, {297, 0}, {297, 210}};
    const auto of_paper = paper.checked(places, seed), of_tip = tip.checked(places, seed);
    if (!of_paper) {
      const auto said = text_in(of_paper.error().details, "moved");
      EXPECT_NE(said, "tip") << seed;
      papers += said == "paper";
    }
    if (!of_tip) {
      const auto said = text_in(of_tip.error().details, "moved");
      EXPECT_NE(said, "paper") << seed;
      tips += said == "tip";
    }
  }
  std::printf("figure: of 100 rigs each, a moved paper was told by name %d times, a moved tip %d times\n",
              papers, tips);
  EXPECT_GT(papers, 90);
  EXPECT_GT(tips, 50);
}

}  // namespace
}  // namespace fude
