// What a tablet's pressure weighs: a pen pressed on a kitchen scale.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calibration/pen_presses.h"
#include "calibration/report.h"
#include "signal/pen_sample.h"
#include "signal/units.h"

namespace fude {

// Force over pressure: monotone cubics between knots (Fritsch and Butland 1984), both ascending.
struct PressureCurve {
  std::vector<double> pressure;  // 0 to 1 of the device's range; the first is 0
  std::vector<double> force_n;   // the first is the force at which the pen begins to feel
  // The force from which on the pen says 1; none: it was not pressed that hard.
  std::optional<double> saturation_n;
};
Fields to_fields(const PressureCurve& curve);
std::optional<PressureCurve> pressure_curve_from(const Fields& fields);

// Newtons. At pressure 0 the threshold, under which the pen feels nothing; beyond the last knot the curve
// goes on straight.
double force_n(const PressureCurve& curve, Fraction pressure);
// Its inverse: 0 up to the threshold, 1 from the saturation on, or where the curve reaches 1.
Fraction pressure_at(const PressureCurve& curve, double force_n);

struct Weighing {
  double grams = 0;
  std::optional<Timestamp> at;  // of the scale's reading; none: that of the next press
};

class PressureProcedure {
 public:
  // One for each press, in their order; or all with times.
  explicit PressureProcedure(std::vector<Weighing> weighings) : weighings_(std::move(weighings)) {}

  Progress add(const PenSample& sample);

  // In newtons. Levels that the pen tells apart are averaged; `held_out_rms` is of levels between others,
  // each foretold without it. Refused: another number of presses than of weighings; weights that are none;
  // fewer than six levels below saturation; a pressure that stays; more than a tenth of the largest force
  // against the order.
  Calibration<PressureCurve> finish() const;

 private:
  std::vector<Weighing> weighings_;
  PressListener listener_;
  std::vector<PenSample> heard_;  // where weighings have times
  std::size_t samples_ = 0;
};

}  // namespace fude
