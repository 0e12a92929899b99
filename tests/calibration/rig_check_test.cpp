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
  rig.now_from_then = moved(12, -3, 0, 1.5);
  const auto found = rig.checked();
  ASSERT_FALSE(found);
  const CalibrationReport& report = found.error();
  EXPECT_EQ(text_in(report.details, "moved"), "paper");
  EXPECT_NEAR(detail(report, "paper_right_mm"), 12, 0.5);
  EXPECT_NEAR(detail(report, "paper_up_mm"), -3, 0.5);
  EXPECT_NEAR(detail(report, "paper_off_mm"), 0, 0.5);
  EXPECT_NEAR(detail(report, "paper_turned_deg"), 1.5, 0.2);
  EXPECT_NE(report.reason.find("to the right"), std::string::npos) << report.reason;
}

TEST(RigCheck, ATrackerThatWasKnockedLiftsAndTiltsThePaper) {
  Rig rig;
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.06, Eigen::Vector3d(1, 2, 1).normalized()));
  rig.now_from_then = {turn, Eigen::Vector3d(3, 2, 15)};
  const auto found = rig.checked();
  ASSERT_FALSE(found);
  EXPECT_EQ(text_in(found.error().details, "moved"), "tracker") << found.error().reason;
  EXPECT_NEAR(detail(found.error(), "paper_tilted_deg"), 0.06 * 57.3 * std::sqrt(5.0 / 6), 0.3);
  EXPECT_NE(found.error().reason.find("the tracker moved, or the table"), std::string::npos);
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
  const auto said = text_in(found.error().details, "moved");
  EXPECT_TRUE(said == "both" || said == "unclear") << found.error().reason;
  // Six touches leave more to tell by.
  const auto more = rig.checked({{0, 0}, {297, 0}, {297, 210}, {0, 210}, {0, 0}, {297, 0}, {297, 210}});
  ASSERT_FALSE(more);
  EXPECT_EQ(text_in(more.error().details, "moved"), "both") << more.error().reason;
  EXPECT_NE(more.error().reason.find("and the paper too"), std::string::npos) << more.error().reason;
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
  EXPECT_EQ(text_in(above.error().details, "moved"), "paper") << above.error().reason;
  // With a handle that always leans alike as well a longer tip.
  rig.lean_rad = 0;
  const auto either = rig.checked(inside);
  ASSERT_FALSE(either);
  EXPECT_EQ(text_in(either.error().details, "moved"), "unclear");
  EXPECT_NE(either.error().reason.find("six or more places"), std::string::npos) << either.error().reason;
  // Corners that were never touched are not the paper's.
  rig.corners = false;
  EXPECT_EQ(rig.checked().error().warnings.size(), 1U);
}

// Without corners: what a tip that moved is off in height goes with how the handle leans.
TEST(RigCheck, EightHeightsTellATipFromATracker) {
  const std::vector<Eigen::Vector2d> inside{{60, 40},  {240, 50},  {230, 160}, {70, 170},
                                            {150, 60}, {160, 110}, {90, 100},  {220, 100}};
  Rig tip, tracker;
  tip.corners = tracker.corners = false;
  tip.true_tip_m += Eigen::Vector3d(0.004, -0.004, 0);
  tracker.now_from_then = {Eigen::Quaterniond(Eigen::AngleAxisd(0.03, Eigen::Vector3d::UnitX())),
                           Eigen::Vector3d(0, 0, 4)};
  EXPECT_EQ(text_in(tip.checked(inside).error().details, "moved"), "tip");
  EXPECT_EQ(text_in(tracker.checked(inside).error().details, "moved"), "tracker");
}

TEST(RigCheck, ARestElsewhereDoesNotCount) {
  const auto found = Rig().checked({{150, -400}, {0, 0}, {297, 0}, {140, 100}, {297, 210}});
  ASSERT_TRUE(found) << found.error().reason;
  EXPECT_EQ(found->report.n, 3U);
}

TEST(RigCheck, TooFewTouchesAreNamed) {
  const auto found = Rig().checked({{0, 0}, {297, 0}});
  ASSERT_FALSE(found);
  EXPECT_NE(found.error().reason.find("rested at 2 places"), std::string::npos) << found.error().reason;
}

// Of rigs of which one thing moved, which is told by name, and none wrongly: what moved against the tracker
// is never called a tip, nor a tip what it is not.
TEST(RigCheck, NoneIsTakenForAnother) {
  struct Count {
    int moved = 0, named = 0;
    void add(const Calibration<RigCheck>& found, const char* name, std::initializer_list<const char*> wrong) {
      if (found) return;
      const std::string said = text_in(found.error().details, "moved").value_or("");
      ++moved;
      named += said == name;
      for (const char* other : wrong) EXPECT_NE(said, other) << found.error().reason;
    }
  } papers, trackers, tips;
  const std::vector<Eigen::Vector2d> places{{0, 0}, {297, 0}, {297, 210}};
  for (std::uint32_t seed = 1; seed <= 200; ++seed) {
    Noise noise(seed);
    Rig paper, tracker, tip;
    paper.now_from_then = moved(noise.uniform(-10, 10), noise.uniform(-10, 10), 0, noise.uniform(-2, 2));
    const Eigen::Vector3d turn = noise.vector(0.02);
    tracker.now_from_then = {Eigen::Quaterniond(Eigen::AngleAxisd(turn.norm(), turn.normalized())),
                             noise.vector(8)};
    tip.true_tip_m +=
        1e-3 * Eigen::Vector3d(noise.uniform(-6, 6), noise.uniform(-6, 6), noise.uniform(-6, 6));
    papers.add(paper.checked(places, seed), "paper", {"tip", "both"});
    trackers.add(tracker.checked(places, seed), "tracker", {"tip", "both"});
    tips.add(tip.checked(places, seed), "tip", {"paper", "tracker", "both"});
  }
  std::printf(
      "figure: what moved was told by name: the paper in %d of %d rigs, the tracker in %d of %d, the tip in "
      "%d "
      "of %d; else that it cannot be told\n",
      papers.named, papers.moved, trackers.named, trackers.moved, tips.named, tips.moved);
  EXPECT_GT(papers.named, 9 * papers.moved / 10);
  EXPECT_GT(trackers.named, 8 * trackers.moved / 10);
  EXPECT_GT(tips.named, 9 * tips.moved / 10);
}

}  // namespace
}  // namespace fude
