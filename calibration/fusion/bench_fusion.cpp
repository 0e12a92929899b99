#include "calibration/fusion/bench_fusion.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include "calibration/fusion/fusion.h"

namespace fude {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int batches = 21, batch = 1000;

double ns_since(Clock::time_point begin) {
  return std::chrono::duration<double, std::nano>(Clock::now() - begin).count();
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

Timestamp at_ms(int ms) { return Timestamp(std::chrono::milliseconds(ms)); }

InertialReading reading_at(int ms) {
  const double t = ms * 1e-3;
  return {{std::sin(3 * t), std::cos(2 * t), std::sin(t)},
          {std::sin(5 * t), std::cos(7 * t), 9.81},
          Eigen::Vector3d(2 * std::sin(t), 18, -40)};
}

}  // namespace

FusionBench bench_fusion() {
  FusionBench bench;
  std::vector<InertialReading> readings;
  for (int ms = 0; ms < batches * batch; ++ms) readings.push_back(reading_at(ms));
  std::vector<double> orientation, inertial, position, late, share;
  OrientationFilter filter;
  Fusion fusion;
  for (int b = 0; b < batches; ++b) {
    const auto begin = Clock::now();
    for (int i = 0; i < batch; ++i) filter.add(readings[static_cast<std::size_t>(b * batch + i)], 1e-3);
    orientation.push_back(ns_since(begin) / batch);

    double in_inertial = 0, in_position = 0, in_late = 0;
    for (int i = 0; i < batch; ++i) {
      const int ms = b * batch + i;
      auto at = Clock::now();
      fusion.add(readings[static_cast<std::size_t>(ms)], at_ms(ms));
      in_inertial += ns_since(at);
      at = Clock::now();
      if (i % 10 == 0) {
        fusion.add(PointFix{}, at_ms(ms));
        in_position += ns_since(at);
      } else if (i % 100 == 55 && ms > 60) {
        fusion.add(PointFix{}, at_ms(ms - 50));
        in_late += ns_since(at);
      }
    }
    inertial.push_back(in_inertial / batch);
    position.push_back(in_position / (batch / 10));
    late.push_back(in_late / (batch / 100) / 1000);
    share.push_back((in_inertial + in_position) / (batch * 1e6));
  }
  bench.ns_per_orientation = median(orientation);
  bench.ns_per_inertial = median(inertial);
  bench.ns_per_position = median(position);
  bench.us_per_late = median(late);
  bench.core_share = median(share);
  return bench;
}

}  // namespace fude
