// How much later, or earlier, one stream's times are than another's: by touches that both show, or by a
// motion that both see.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "calibration/delay/delay_estimate.h"
#include "calibration/delay/witness.h"
#include "calibration/report.h"

namespace fude {

// Added to B's times to bring them to A's: offset_s, and, where the clocks drift, drift_ppm millionths of the
// time since reference_s more. A drift counts in its own session alone.
struct DelayCalibration {
  std::string a, b;
  double offset_s = 0;
  std::optional<double> drift_ppm;
  double reference_s = 0;  // of the session
};
Fields to_fields(const DelayCalibration& delay);
std::optional<DelayCalibration> delay_from(const Fields& fields);

enum class DelaySide { a, b };

class DelayProcedure {
 public:
  DelayProcedure(WitnessReader a, WitnessReader b) : a_(std::move(a)), b_(std::move(b)) {}

  // Before its first sample: where the tip of a stream's tool is, and the sheet that it touches.
  void know(DelaySide side, std::optional<Eigen::Vector3d> tip_m, std::optional<SurfaceCalibration> surface) {
    (side == DelaySide::a ? a_ : b_).know(tip_m, std::move(surface));
  }

  Progress add(DelaySide side, const Sample& sample);

  // The way is chosen by what the streams are (delay_between). Residuals are in ms, of touches as time at the
  // usual speed of touching; ci95 is the offset's interval, in ms. Refused, each with its likely cause:
  // nothing usable, a frozen stream, a clock that starts anew, no overlap, too few strokes, all at one speed,
  // strokes so even that they could be paired otherwise, streams that do not see the same, an interval wider
  // than 5 ms to either side. Details: the method, the drift with its interval also where it is too small to
  // count, the course of the offset over the session.
  Calibration<DelayCalibration> finish() const;

 private:
  WitnessReader a_, b_;
};

}  // namespace fude
