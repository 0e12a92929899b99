#include "rig/fusion/up_from_gravity.h"

#include <algorithm>
#include <cmath>

namespace fude {
namespace {

constexpr int fewest_readings = 100;
constexpr Duration longest_since_pose = std::chrono::milliseconds(50);
constexpr double gravity_mps2 = 9.81, most_off_mps2 = 0.5;

std::vector<const UsableSample*> in_order_of_time(const std::vector<UsableSample>& samples) {
  std::vector<const UsableSample*> ordered;
  for (const UsableSample& sample : samples) ordered.push_back(&sample);
  std::stable_sort(ordered.begin(), ordered.end(),
                   [](const UsableSample* a, const UsableSample* b) { return a->time < b->time; });
  return ordered;
}

}  // namespace

std::optional<Eigen::Vector3d> up_from_gravity(const std::vector<UsableSample>& samples) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int readings = 0;
  std::optional<Timestamp> seen;
  Eigen::Quaterniond world_from_sensor = Eigen::Quaterniond::Identity();
  for (const UsableSample* at : in_order_of_time(samples)) {
    const UsableSample& sample = *at;
    if (const auto* fix = std::get_if<Fix>(&sample.what)) {
      const auto* pose = std::get_if<PoseFix>(fix);
      if (pose == nullptr || !sound(*fix)) continue;
      seen = sample.time;
      world_from_sensor = pose->world_from_sensor;
    } else if (const auto& imu = std::get<ImuSample>(sample.what);
               seen && imu.valid && imu.specific_force_mps2.allFinite() &&
               std::chrono::abs(sample.time - *seen) <= longest_since_pose) {
      sum += world_from_sensor * imu.specific_force_mps2;
      ++readings;
    }
  }
  if (readings < fewest_readings) return std::nullopt;
  const Eigen::Vector3d mean = sum / readings;
  if (std::abs(mean.norm() - gravity_mps2) > most_off_mps2) return std::nullopt;
  return mean.normalized();
}

}  // namespace fude
