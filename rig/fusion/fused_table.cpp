#include "rig/fusion/fused_table.h"

#include <cstdio>
#include <cstdlib>

#include "rig/fusion/fix_of.h"

namespace fude {
namespace {

const char* name_of(FusionState state) {
  return state == FusionState::ok ? "OK" : state == FusionState::predicted ? "PREDICTED" : "LOST";
}

}  // namespace

FusedRow row_of(const FusedPose& pose, Timestamp stamped) {
  FusedRow row{.time = stamped, .state = pose.state};
  if (pose.world_from_sensor.coeffs().allFinite()) row.world_from_sensor = pose.world_from_sensor;
  if (pose.state != FusionState::lost) row.position_m = pose.point_m;
  row.covariance = pose.covariance;
  return row;
}

PoseSample sample_of(const FusedRow& row, const std::string& tool, std::uint64_t sequence) {
  PoseSample sample{.tool = tool};
  sample.time = {.host = row.time, .stamped_by = StampedBy::recording, .sequence = sequence};
  sample.valid = row.position_m && row.world_from_sensor;
  sample.origin = !sample.valid                  ? PoseOrigin::none
                  : row.state == FusionState::ok ? PoseOrigin::measured
                                                 : PoseOrigin::predicted;
  sample.tracker_from_tool = {row.world_from_sensor.value_or(Eigen::Quaterniond::Identity()),
                              row.position_m.value_or(Eigen::Vector3d::Zero())};
  if (row.world_from_sensor) sample.covariance = rotation_first(row.covariance);
  return sample;
}

std::string csv_of(const FusedSession& fused) {
  std::string text = "t_s,x_m,y_m,z_m,qw,qx,qy,qz,var_0,var_1,var_2,var_3,var_4,var_5,state\n";
  char field[40];
  const auto number = [&](double value, const char* format) {
    std::snprintf(field, sizeof field, format, value);
    text += ',';
    text += field;
  };
  for (const FusedRow& row : fused.rows) {
    const auto ns = row.time.time_since_epoch().count();
    std::snprintf(field, sizeof field, "%s%lld.%09lld", ns < 0 ? "-" : "",
                  static_cast<long long>(std::abs(ns) / 1'000'000'000),
                  static_cast<long long>(std::abs(ns) % 1'000'000'000));
    text += field;
    if (row.position_m)
      for (int i = 0; i < 3; ++i) number((*row.position_m)[i], "%.7f");
    else
      text += ",,,";
    const auto& q = row.world_from_sensor;
    if (q)
      for (const double part : {q->w(), q->x(), q->y(), q->z()}) number(part, "%.9f");
    else
      text += ",,,,";
    for (int i = 0; i < 6; ++i) {
      if (i < 3 ? row.position_m.has_value() : q.has_value())
        number(row.covariance(i, i), "%.6g");
      else
        text += ',';
    }
    text += ',';
    text += name_of(row.state);
    text += '\n';
  }
  return text;
}

}  // namespace fude
