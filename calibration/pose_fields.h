// Poses among the fields of a result: `KEY_q`, a quaternion w, x, y, z, and `KEY_m`, metres.
#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "calibration/report.h"
#include "signal/pose.h"

namespace fude {

template <class To, class From>
void put_pose(Fields& fields, const std::string& key, const Pose<To, From>& pose) {
  const Eigen::Quaterniond& q = pose.rotation;
  const Eigen::Vector3d& t = pose.translation;
  fields.push_back({key + "_q", std::vector{q.w(), q.x(), q.y(), q.z()}});
  fields.push_back({key + "_m", std::vector{t.x(), t.y(), t.z()}});
}

// None where it is not there, or is no rotation.
inline std::optional<Eigen::Quaterniond> rotation_in(const Fields& fields, const std::string& key) {
  const auto q = numbers_in(fields, key);
  if (!q || q->size() != 4) return std::nullopt;
  const Eigen::Quaterniond rotation((*q)[0], (*q)[1], (*q)[2], (*q)[3]);
  if (!(std::abs(rotation.norm() - 1) < 1e-3)) return std::nullopt;
  return rotation.normalized();
}

template <class To, class From>
std::optional<Pose<To, From>> pose_in(const Fields& fields, const std::string& key) {
  const auto rotation = rotation_in(fields, key + "_q");
  const auto t = numbers_in(fields, key + "_m");
  if (!rotation || !t || t->size() != 3 || !Eigen::Vector3d(t->data()).allFinite()) return std::nullopt;
  return Pose<To, From>{*rotation, Eigen::Vector3d(t->data())};
}

}  // namespace fude
