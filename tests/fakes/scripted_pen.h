// A pen with known answers: taps at places of a tablet and presses on a scale, with seeded noise.
#pragma once

#include <Eigen/Core>
#include <chrono>
#include <vector>

#include "signal/pen_sample.h"

namespace fude {

inline PenSample pen_sample(double t_s, const Eigen::Vector2d& counts, bool touches, double pressure = 0.3) {
  PenSample sample;
  sample.tool = PenTool::pen;
  sample.in_proximity = true;
  sample.in_contact = touches;
  sample.time.host = Timestamp(std::chrono::duration_cast<Duration>(std::chrono::duration<double>(t_s)));
  sample.x_counts = counts.x();
  sample.y_counts = counts.y();
  sample.pressure = Fraction(touches ? pressure : 0);
  return sample;
}

// Comes down, rests for 0.3 s and hovers away, at 100 Hz, after what is there already.
inline void tap(std::vector<PenSample>& samples, const PenSample& at) {
  double t = samples.empty() ? 0 : seconds(samples.back().time.host.time_since_epoch());
  for (int i = 0; i < 50; ++i) {
    t += 0.01;
    PenSample sample = at;
    const bool touches = i >= 10 && i < 40;
    sample.time.host = pen_sample(t, Eigen::Vector2d::Zero(), false).time.host;
    sample.in_contact = touches;
    if (!touches) sample.pressure = Fraction(0);
    samples.push_back(sample);
  }
}

}  // namespace fude
