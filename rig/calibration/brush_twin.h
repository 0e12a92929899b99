// `fude calibrate brush`: the twin of a real brush from the marks that it left, with a report as of any
// calibration.
#pragma once

#include <functional>
#include <span>
#include <string>

#include "rig/calibration/calibrator.h"
#include "sim/brush/brush_spec.h"
#include "sim/brush/twin_trial.h"

namespace fude {

struct BrushTwin {
  CalibrationOutcome outcome;  // result: what was found, under the keys of the brush
  BrushSpec spec;              // `known` with it; as it was where it is refused
};

// `known` is the brush with its lengths and radii as measured. Refused, each by its likely cause: fewer than
// five trials; no drag; poses in metres or that never reach the paper; marks of another scale or place than
// the poses; a parameter that the gestures do not show; marks that no such brush leaves.
BrushTwin twin_of(const BrushSpec& known, std::span<const TwinTrial> trials, int starts,
                  const std::function<void(double)>& progress);

// A file for share/brushes: every value that is not the standard one. `remark` comes first.
std::string toml_of(const BrushSpec& spec, const std::string& remark);

}  // namespace fude
