// What must hold of every sample, whatever the bytes were that it was made of.
#pragma once

#include <cmath>
#include <variant>

#include "signal/sample.h"

namespace fude {
namespace sound {

inline bool share(double value) { return value >= 0 && value <= 1; }
inline bool share(const std::optional<Fraction>& value) { return !value || share(value->value); }
inline bool finite(const std::optional<double>& value) { return !value || std::isfinite(*value); }

inline bool check(const PenSample& s) {
  return std::isfinite(s.x_counts) && std::isfinite(s.y_counts) && share(s.pressure.value) &&
         share(s.distance) && share(s.wheel) && s.in_proximity == (s.tool != PenTool::none) &&
         (s.in_proximity || !s.in_contact);
}
inline bool check(const TouchSample& s) {
  return std::isfinite(s.x_counts) && std::isfinite(s.y_counts) && finite(s.major_counts) &&
         finite(s.minor_counts) && share(s.pressure) &&
         (!s.orientation || std::abs(s.orientation->value) < 3.2);
}
inline bool check(const ImuSample& s) {
  return s.turn_rate_radps.allFinite() && s.specific_force_mps2.allFinite() &&
         (!s.magnetic_field_ut || s.magnetic_field_ut->allFinite()) && finite(s.temperature_c) &&
         share(s.battery);
}
inline bool check(const PoseSample& s) {
  const auto& pose = s.tracker_from_tool;
  return pose.translation.allFinite() && std::abs(pose.rotation.norm() - 1) < 1e-9 &&
         (!s.covariance || s.covariance->allFinite()) && finite(s.residual_m);
}
inline bool check(const PositionSample& s) {
  return s.tracker_from_marker_m.allFinite() && (!s.covariance_m2 || s.covariance_m2->allFinite()) &&
         finite(s.residual_m);
}
inline bool check(const RangeSample& s) {
  for (const auto& flight : s.flight_s)
    if (flight && !(*flight >= 0 && *flight < 1)) return false;
  for (double amplitude : s.amplitude)
    if (!share(amplitude)) return false;
  return s.receivers <= most_receivers && finite(s.temperature_c);
}
inline bool check(const PuckSample& s) {
  return s.push.cwiseAbs().maxCoeff() <= 1 && s.turn.cwiseAbs().maxCoeff() <= 1;
}
inline bool check(const GloveSample& s) {
  for (const Fraction& bend : s.bend)
    if (!share(bend.value)) return false;
  for (const auto& light : s.lights)
    if (light && !light->allFinite()) return false;
  return true;
}
inline bool check(const HapticSample& s) {
  return s.position_m.allFinite() && s.velocity_mps.allFinite() && s.force_n.allFinite();
}
inline bool check(const CameraFrame& s) { return finite(s.exposure_s); }
inline bool check(const TickSample&) { return true; }

}  // namespace sound

// Finite, within its range, a turn of unit length.
inline bool is_sound(const Sample& sample) {
  return std::visit([](const auto& s) { return sound::check(s); }, sample);
}

}  // namespace fude
