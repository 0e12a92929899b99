// A smooth function in the plane as named numbers of a stored calibration.
#pragma once

#include <optional>
#include <string>

#include "calibration/report.h"
#include "calibration/smooth_field.h"

namespace fude {

// Keys NAME_centre_mm, NAME_scale_mm, NAME_knots (without unit: (mm − centre)/scale), NAME_weights_mm and
// NAME_polynomial_mm, of functions of a point in millimetres that give millimetres.
void store(Fields& fields, const std::string& name, const SmoothField& field);

// Of that many functions. None where a key is missing, a number is not finite or their counts do not fit.
std::optional<SmoothField> stored_field(const Fields& fields, const std::string& name, int functions);

}  // namespace fude
