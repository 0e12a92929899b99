// A tracker with known answers: tools that pivot, spin and touch along analytic motions, with seeded noise.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <chrono>
#include <cstdint>
#include <random>
#include <vector>

#include "signal/pose_sample.h"

namespace fude {

// A seeded source of noise.
class Noise {
 public:
  explicit Noise(std::uint32_t seed) : random_(seed) {}
  double normal(double sigma) { return sigma * gauss_(random_); }
  double uniform(double low, double high) {
    return low + (high - low) * std::uniform_real_distribution<>()(random_);
  }
  Eigen::Vector3d vector(double sigma) { return {normal(sigma), normal(sigma), normal(sigma)}; }

 private:
  std::mt19937 random_;
  std::normal_distribution<> gauss_;
};

inline PoseSample pose_sample(const Pose<Tracker, Tool>& pose, double t_s) {
  PoseSample sample;
  sample.tool = "brush";
  sample.time.host = Timestamp(std::chrono::duration_cast<Duration>(std::chrono::duration<double>(t_s)));
  sample.tracker_from_tool = pose;
  return sample;
}

// Turns about the tip, leaning up to `lean_rad` in all directions (or, with `flatness` 0, about x alone).
struct ScriptedPivot {
  Eigen::Vector3d tip_m{-0.014, 0.15, -0.007};
  Eigen::Vector3d pivot_m{0.2, -0.1, -1.1};
  double lean_rad = 0.6;
  double flatness = 1;
  double noise_m = 0;
  int poses = 200;

  std::vector<PoseSample> samples(std::uint32_t seed = 7) const {
    Noise noise(seed);
    const Eigen::Quaterniond rest(Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, -0.5).normalized()));
    std::vector<PoseSample> all;
    for (int i = 0; i < poses; ++i) {
      const double t = i / 30.0;
      const Eigen::Vector3d lean(lean_rad * std::sin(2.1 * t), flatness * lean_rad * std::sin(3.3 * t + 1),
                                 flatness * 0.5 * lean_rad * std::sin(0.7 * t));
      const Eigen::Quaterniond turn =
          lean.norm() > 0 ? Eigen::Quaterniond(Eigen::AngleAxisd(lean.norm(), lean.normalized()))
                          : Eigen::Quaterniond::Identity();
      const Eigen::Quaterniond r = rest * turn;
      all.push_back(pose_sample({r, pivot_m - r * tip_m + noise.vector(noise_m)}, t));
    }
    return all;
  }
};

}  // namespace fude
