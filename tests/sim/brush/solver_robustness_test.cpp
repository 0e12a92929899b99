// What the solver does where it is not given what it wants: no iterations, no sense, no time.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <random>

#include "sim/brush/bench_gesture.h"
#include "sim/brush/tuft_step.h"
#include "tests/sim/brush/gesture.h"

namespace fude {
namespace {

constexpr double step_s = 0.004;
constexpr int frames = 2000;

Eigen::Vector3d tip_of(const Tuft& tuft, const TuftState& state) {
  return pose_skeleton(tuft, state.x, state.paper_from_handle).node[static_cast<std::size_t>(tuft.segments)];
}

TEST(SolverRobustness, EveryGestureConvergesInEveryFrame) {
  for (const BenchGesture& gesture : bench_gestures()) {
    const Tuft tuft = make_tuft(BrushSpec{});
    TuftState state = rest_state(tuft);
    int most = 0;
    for (int f = 0; f < frames; ++f) {
      const SolveReport report = advance(tuft, state, gesture.pose(tuft.spec, f * step_s), step_s, f == 0);
      EXPECT_TRUE(report.converged) << gesture.name << " frame " << f;
      EXPECT_LE(report.violation_mm, 1e-6 * tuft.spec.tuft_length_mm);
      most = std::max(most, report.iterations);
    }
    EXPECT_LE(most, 12) << gesture.name;
  }
}

// The handle's path is smooth; the tip's has a corner where it meets the paper and no other.
TEST(SolverRobustness, TheTipDoesNotJerk) {
  for (const BenchGesture& gesture : bench_gestures()) {
    const Tuft tuft = make_tuft(BrushSpec{});
    TuftState state = rest_state(tuft);
    Eigen::Vector3d last = Eigen::Vector3d::Zero();
    Eigen::Vector3d before_last = Eigen::Vector3d::Zero();
    double worst = 0;
    double fastest = 0;  // of the handle, mm a frame
    for (int f = 0; f < frames; ++f) {
      const Pose<Paper, Handle> pose = gesture.pose(tuft.spec, f * step_s);
      if (f > 0) fastest = std::max(fastest, (pose.translation - state.paper_from_handle.translation).norm());
      advance(tuft, state, pose, step_s, f == 0);
      const Eigen::Vector3d tip = tip_of(tuft, state);
      if (f > 1) worst = std::max(worst, (tip - 2 * last + before_last).norm());
      before_last = last;
      last = tip;
    }
    std::printf(
        "figure: %s: second difference of the tip's path at most %.3f mm a frame of 4 ms, the handle moves "
        "%.2f mm\n",
        gesture.name.data(), worst, fastest);
    EXPECT_LE(worst, 0.15 + fastest) << gesture.name;
    EXPECT_LE(worst, 0.04 * tuft.spec.tuft_length_mm) << gesture.name;
  }
}

TEST(SolverRobustness, AnUnconvergedFrameIsToldAndTheNextStartsClean) {
  const BenchGesture& gesture = bench_gestures()[0];
  const Tuft tuft = make_tuft(BrushSpec{});
  Tuft starved = tuft;
  starved.spec.iteration_limit = 1;
  TuftState state = rest_state(tuft);
  TuftState undisturbed = rest_state(tuft);
  int told = 0;
  int later = 0;
  for (int f = 0; f < 900; ++f) {
    const bool starving = f % 100 >= 95;
    const Pose<Paper, Handle> pose = gesture.pose(tuft.spec, f * step_s);
    const SolveReport report = advance(starving ? starved : tuft, state, pose, step_s, f == 0);
    EXPECT_LE(report.iterations, starving ? 1 : 20);
    (starving ? told : later) += report.converged ? 0 : 1;
    advance(tuft, undisturbed, pose, step_s, f == 0);
  }
  EXPECT_GE(told, 10);
  EXPECT_EQ(later, 0);
  const double apart = (tip_of(tuft, state) - tip_of(tuft, undisturbed)).norm();
  std::printf("figure: after %d starved frames the tip is %.4f mm from where it would be\n", told, apart);
  EXPECT_LE(apart, 0.05);
}

TEST(SolverRobustness, AnyPoseIsSurvived) {
  std::mt19937 random(20);
  std::uniform_real_distribution<double> any(-1, 1);
  const double steps[] = {0, 1e-9, 1e-6, 1e-3, 4e-3, 0.1, 1, 1e9};
  const Tuft tuft = make_tuft(BrushSpec{});
  TuftState state = rest_state(tuft);
  int unconverged = 0;
  for (int i = 0; i < 1500; ++i) {
    Pose<Paper, Handle> pose;
    pose.rotation = Eigen::Quaterniond(any(random), any(random), any(random), any(random)).normalized();
    const double reach = i % 3 == 0 ? 1000 : 30;  // a metre away, or near the paper and below it
    pose.translation = reach * Eigen::Vector3d(any(random), any(random), any(random));
    const double dt = steps[std::uniform_int_distribution<std::size_t>(0, 7)(random)];
    const SolveReport report = advance(tuft, state, pose, dt, any(random) > 0);
    ASSERT_TRUE(state.x.allFinite() && state.reactions.allFinite() && tip_of(tuft, state).allFinite()) << i;
    ASSERT_TRUE(std::isfinite(report.kkt_residual) && std::isfinite(report.energy_mn_mm));
    ASSERT_TRUE(report.on_hand.force_n.allFinite() && report.on_hand.torque_nmm.allFinite());
    unconverged += report.converged ? 0 : 1;
    if (report.converged) {
      EXPECT_LE(report.violation_mm, 1e-6 * tuft.spec.tuft_length_mm);
    }
  }
  std::printf("figure: of 1500 random poses %d were told as not converged\n", unconverged);
  // And then a hand again.
  for (int f = 0; f < 250; ++f) {
    const SolveReport report = advance(tuft, state, leaning(0, 0, 40 - 0.08 * f, 0.25, 0), step_s, f == 0);
    EXPECT_TRUE(report.converged) << f;
  }
}

TEST(SolverRobustness, APoseThatIsNoNumberIsRefused) {
  Brush brush(BrushSpec{}, 1);
  brush.move(input_at(0, leaning(0, 0, 24, 0.2, 0)));
  const Pose<Paper, Handle> good = brush.state().paper_from_handle;
  Pose<Paper, Handle> bad = good;
  bad.translation.x() = std::numeric_limits<double>::quiet_NaN();
  const BrushFrame frame = brush.move(input_at(0.004, bad));
  EXPECT_FALSE(frame.deposit);
  EXPECT_EQ(frame.solve.on_hand.force_n.norm(), 0);
  EXPECT_TRUE(brush.move(input_at(0.008, good)).solve.converged);
  EXPECT_TRUE(brush.shape().front().spine.back().allFinite());
}

}  // namespace
}  // namespace fude
