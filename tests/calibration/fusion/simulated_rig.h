// A simulated hand with an inertial unit, and a fusion that hears of it.
#pragma once

#include "tests/calibration/fusion/simulated_hand.h"

namespace fude {

// A 1 kHz inertial unit and whatever fixes a test adds.
class Rig {
 public:
  explicit Rig(const FusionSettings& settings = {}, unsigned seed = 1)
      : fusion(settings), noise(seed), settings_(settings) {}

  void inertial(double t) {
    fusion.add(noise.onto(hand.reading(t, step_s), step_s, settings_.noise), at_second(t));
  }
  FixResult point(double t, double sigma_m, const Eigen::Vector3d& offset = Eigen::Vector3d::Zero()) {
    PointFix fix{.point_m = hand.position(t) + offset + noise.vector(sigma_m)};
    fix.covariance_m2 = Eigen::Matrix3d::Identity() * sigma_m * sigma_m;
    return fusion.add(fix, at_second(t));
  }
  Eigen::Vector3d error(double t) const { return fusion.pose().point_m - hand.position(t); }

  static constexpr double step_s = 1e-3;
  SimulatedHand hand;
  Fusion fusion;
  SimulatedNoise noise;

 private:
  FusionSettings settings_;
};

// Divides t by a period of so many milliseconds.
inline bool due(int ms, int period_ms) { return ms % period_ms == 0; }

}  // namespace fude
