// Where a tip touched: the places at which it rested, out of its whole way.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "signal/timestamp.h"

namespace fude {

struct TipPoint {
  Timestamp time;
  Eigen::Vector3d point_m = Eigen::Vector3d::Zero();
  std::size_t number = 0;  // of the sample, or the first of them
};

// Runs of at least `shortest` and three samples within which the tip stays `nearest_m` or closer to their
// mean, each as that mean; runs that follow closer than twice that apart are one touch.
struct RestingTip {
  Duration shortest = std::chrono::milliseconds(200);
  double nearest_m = 1e-3;
};
std::vector<TipPoint> resting_places(std::span<const TipPoint> way, const RestingTip& rest = {});

}  // namespace fude
