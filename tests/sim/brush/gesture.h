// Hands for tests: poses over time, sampled at a rate, led through a brush.
#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include "sim/brush/brush.h"

namespace fude {

struct Gesture {
  double seconds = 0;
  std::function<Pose<Paper, Handle>(double)> pose;
};

inline Pose<Paper, Handle> upright(double x, double y, double z) {
  Pose<Paper, Handle> pose;
  pose.translation = {x, y, z};
  return pose;
}

// Leaning by `tilt` rad towards the direction `towards` (rad, from +x), the axis through the point.
inline Pose<Paper, Handle> leaning(double x, double y, double z, double tilt, double towards) {
  Pose<Paper, Handle> pose = upright(x, y, z);
  pose.rotation =
      Eigen::Quaterniond(Eigen::AngleAxisd(tilt, Eigen::Vector3d(-std::sin(towards), std::cos(towards), 0)));
  return pose;
}

inline double ease(double t) {
  const double u = std::clamp(t, 0.0, 1.0);
  return u * u * (3 - 2 * u);
}

inline BrushInput input_at(double seconds, const Pose<Paper, Handle>& pose) {
  BrushInput input;
  input.time.host = Timestamp(Duration(static_cast<std::int64_t>(std::llround(seconds * 1e9))));
  input.origin = PoseOrigin::measured;
  input.paper_from_handle = pose;
  return input;
}

struct Trace {
  std::vector<Eigen::Vector3d> tip;  // after each sample
  double film_mm2 = 0;               // newly covered
  double contact_mm2_s = 0;          // area times time
  int unconverged = 0;
};

inline Trace perform(Brush& brush, const Gesture& gesture, double rate_hz, double start_s = 0) {
  Trace trace;
  const int samples = static_cast<int>(std::llround(gesture.seconds * rate_hz));
  for (int i = 0; i <= samples; ++i) {
    const double t = i / rate_hz;
    const BrushFrame frame = brush.move(input_at(start_s + t, gesture.pose(t)));
    trace.unconverged += frame.solve.converged ? 0 : 1;
    trace.tip.push_back(brush.shape().front().spine.back());
    if (!frame.deposit) continue;
    const FootprintMap& map = frame.deposit->map;
    const double cell = map.cell_mm * map.cell_mm;
    for (std::size_t c = 0; c < map.fresh.size(); ++c) {
      trace.film_mm2 += cell * static_cast<double>(map.fresh[c]);
      trace.contact_mm2_s += cell * static_cast<double>(map.contact_s[c]);
    }
  }
  return trace;
}

}  // namespace fude
