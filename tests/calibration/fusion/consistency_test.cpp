// Errors against what the filter believes of them: innovations of every kind of fix, and the distance from
// the truth, causal and smoothed.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include "calibration/fusion/smoother.h"
#include "tests/calibration/fusion/simulated_rig.h"

namespace fude {
namespace {

constexpr unsigned runs = 8;
constexpr int run_ms = 6000, settled_ms = 3000;

// The simulated unit has no errors of scale, and its offsets stay: neither is expected.
FusionSettings settings() {
  FusionSettings settings;
  settings.noise.gyro_scale = settings.noise.accel_scale = 0;
  settings.start_position_m = {0.1, 0.2, 0.3};
  return settings;
}

const std::array receivers{Eigen::Vector3d(-0.1, 0, 0.5), Eigen::Vector3d(0.4, 0, 0.5),
                           Eigen::Vector3d(0.4, 0.45, 0.5), Eigen::Vector3d(-0.1, 0.45, 0.45),
                           Eigen::Vector3d(0.15, 0.6, 0.1)};
const std::array emitters{Eigen::Vector3d(0.01, 0.01, 0.1), Eigen::Vector3d(0.06, -0.04, 0.02)};
const Eigen::Vector3d tip(0, 0, -0.12);

class Simulation {
 public:
  explicit Simulation(unsigned seed) : noise_(seed) {}

  std::vector<FusionInput> inputs(void (Simulation::*fixes)(int)) {
    for (int ms = 1; ms <= run_ms; ++ms) {
      const double t = ms * 1e-3;
      inputs_.push_back({at_second(t), noise_.onto(hand_.reading(t, 1e-3), 1e-3, settings().noise)});
      (this->*fixes)(ms);
    }
    return inputs_;
  }

  void positions(int ms) {
    if (!due(ms, 10)) return;
    add(ms, PointFix{.point_m = place(ms) + noise_.vector(1e-3)});
  }
  void poses(int ms) {
    if (!due(ms, 10)) return;
    PoseFix fix{.point_m = place(ms) + noise_.vector(1e-3),
                .world_from_sensor = rotation_of(noise_.vector(5e-3)) * turned(ms)};
    fix.covariance.diagonal() << 1e-6, 1e-6, 1e-6, 25e-6, 25e-6, 25e-6;
    add(ms, fix);
  }
  void ranges(int ms) {
    for (std::size_t e = 0; e < emitters.size(); ++e)
      if (ms % 10 == static_cast<int>(5 * e))
        for (const Eigen::Vector3d& receiver : receivers)
          add(ms, RangeFix{.receiver_m = receiver,
                           .emitter_offset_m = emitters[e],
                           .distance_m = (place(ms) + turned(ms) * emitters[e] - receiver).norm() +
                                         noise_.vector(5e-4).x()});
  }
  // Beside positions, without which a contact says too little.
  void contacts(int ms) {
    if (due(ms, 100)) positions(ms);
    if (due(ms, 10))
      add(ms, ContactFix{.tip_offset_m = tip,
                         .height_m = (place(ms) + turned(ms) * tip).z() + noise_.vector(3e-4).x()});
  }

 private:
  Eigen::Vector3d place(int ms) const { return hand_.position(ms * 1e-3); }
  Eigen::Quaterniond turned(int ms) const { return hand_.rotation(ms * 1e-3); }
  void add(int ms, const Fix& fix) { inputs_.push_back({at_second(ms * 1e-3), fix}); }

  SimulatedHand hand_;
  SimulatedNoise noise_;
  std::vector<FusionInput> inputs_;
};

using Fixes = void (Simulation::*)(int);
struct Kind {
  const char* name;
  Fixes fixes;
};
const std::array kinds{Kind{"positions", &Simulation::positions}, Kind{"poses", &Simulation::poses},
                       Kind{"ranges", &Simulation::ranges}, Kind{"contacts", &Simulation::contacts}};

// The mean of chi-square with so many degrees of freedom, over them, is 1; its scatter is √(2/n).
TEST(Consistency, InnovationsOfEveryKindOfFix) {
  for (const Kind& kind : kinds) {
    double sum = 0;
    int rows = 0;
    for (unsigned seed = 1; seed <= runs; ++seed) {
      Fusion fusion(settings());
      for (const FusionInput& input : Simulation(seed).inputs(kind.fixes)) {
        if (const auto* reading = std::get_if<InertialReading>(&input.what)) {
          fusion.add(*reading, input.time);
          continue;
        }
        const FixResult result = fusion.add(std::get<Fix>(input.what), input.time);
        if (input.time <= at_second(settled_ms * 1e-3)) continue;
        EXPECT_NE(result.outcome, FixOutcome::unsound);
        sum += result.squared_innovation;
        rows += result.rows;
      }
    }
    const double bound = 1.96 * std::sqrt(2.0 / rows);
    std::printf("figure: %s: normalised squared innovation %.3f a row, 1 within %.3f at 95 %%\n", kind.name,
                sum / rows, bound);
    EXPECT_NEAR(sum / rows, 1, bound) << kind.name;
  }
}

// Normalised squares of the true error, place and turn apart, twice a second.
struct Believed {
  double place = 0, turn = 0;
  int count = 0;
  void add(const FusedPose& pose) {
    const auto ms =
        std::chrono::duration_cast<std::chrono::milliseconds>(pose.time.time_since_epoch()).count();
    if (ms < settled_ms || ms > run_ms - 500 || ms % 500 != 0) return;
    const SimulatedHand hand;
    const double t = static_cast<double>(ms) * 1e-3;
    const Eigen::Vector3d off = hand.position(t) - pose.point_m;
    const Eigen::Vector3d off_rad = turn_of(hand.rotation(t) * pose.world_from_sensor.conjugate());
    place += off.dot(pose.covariance.topLeftCorner<3, 3>().ldlt().solve(off)) / 3;
    turn += off_rad.dot(pose.covariance.bottomRightCorner<3, 3>().ldlt().solve(off_rad)) / 3;
    ++count;
  }
};

TEST(Consistency, TheTruthIsWhereTheCovarianceSays) {
  for (const Kind& kind : kinds) {
    Believed causal, smoothed;
    for (unsigned seed = 1; seed <= runs / 2; ++seed) {
      const std::vector<FusionInput> inputs = Simulation(seed).inputs(kind.fixes);
      Fusion fusion(settings());
      for (const FusionInput& input : inputs) {
        if (const auto* reading = std::get_if<InertialReading>(&input.what)) {
          causal.add(fusion.pose());
          fusion.add(*reading, input.time);
        } else {
          fusion.add(std::get<Fix>(input.what), input.time);
        }
      }
      if (kind.fixes != &Simulation::ranges)  // a thousand a second: too many to be quick
        for (const FusedPose& pose : smooth(inputs, settings())) smoothed.add(pose);
    }
    for (const auto& [how, believed] : {std::pair("causal", causal), std::pair("smoothed", smoothed)}) {
      if (believed.count == 0) continue;
      std::printf("figure: %s, %s: normalised squared error of the truth %.2f (place), %.2f (turn)\n",
                  kind.name, how, believed.place / believed.count, believed.turn / believed.count);
      for (const double sum : {believed.place, believed.turn}) {
        EXPECT_GT(sum / believed.count, 0.4) << kind.name;
        EXPECT_LT(sum / believed.count, 1.6) << kind.name;
      }
    }
  }
}

// What is predicted for a display is near where the hand will be, and never counts as known.
TEST(Consistency, PredictedForTheDisplay) {
  Rig rig;
  double squares = 0;
  int count = 0;
  for (int ms = 1; ms <= 6000; ++ms) {
    const double t = ms * 1e-3;
    rig.inertial(t);
    if (due(ms, 10)) rig.point(t, 5e-4);
    if (ms < 2000 || !due(ms, 20)) continue;
    const FusedPose now = rig.fusion.pose();
    const FusedPose ahead = rig.fusion.predicted(at_second(t + 0.03));
    EXPECT_EQ(ahead.state, FusionState::predicted);
    EXPECT_EQ(ahead.time, at_second(t + 0.03));
    EXPECT_GT(ahead.covariance(0, 0), now.covariance(0, 0));
    squares += (ahead.point_m - rig.hand.position(t + 0.03)).squaredNorm();
    ++count;
    EXPECT_EQ(rig.fusion.predicted(at_second(t + 60)).time, at_second(t + 0.1));
    EXPECT_EQ(rig.fusion.pose().time, now.time);
  }
  std::printf("figure: predicted 30 ms ahead, off by %.2f mm RMS\n", 1e3 * std::sqrt(squares / count));
  EXPECT_LT(std::sqrt(squares / count), 1.5e-3);
}

}  // namespace
}  // namespace fude
