// The delay between two streams as a session runs: found anew again and again from what was seen lately.
#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "calibration/delay/delay.h"

namespace fude {

struct RunningDelayLimits {
  double window_s = 60;  // of samples that count
  double every_s = 2;    // from one estimate to the next, of A's time
};

// Causal: an estimate rests on the samples added before. Memory is bounded by the window.
class RunningDelay {
 public:
  RunningDelay(const std::string& a, const std::string& b, const RunningDelayLimits& limits = {})
      : a_(a), b_(b), limits_(limits) {}

  // Before its first sample, as DelayProcedure::know.
  void know(DelaySide side, std::optional<Eigen::Vector3d> tip_m, std::optional<SurfaceCalibration> surface) {
    reader(side).know(tip_m, std::move(surface));
  }

  // The next sample of a stream; gives a new estimate where this one brought it. A stream whose clock starts
  // anew begins anew, and the estimates with it.
  std::optional<DelayMoment> add(DelaySide side, const Sample& sample);

  // None before there was enough, and since a clock started anew.
  const std::optional<DelayMoment>& newest() const { return newest_; }
  // Why the last attempt gave none; empty where it did.
  const std::string& missing() const { return missing_; }

 private:
  WitnessReader& reader(DelaySide side) { return side == DelaySide::a ? a_ : b_; }

  WitnessReader a_, b_;
  RunningDelayLimits limits_;
  double next_s_ = -INFINITY;
  std::optional<DelayMoment> newest_;
  std::string missing_;
};

}  // namespace fude
