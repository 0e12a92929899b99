// Digital ink as Wacom's libraries write it into tables; one row a sample, strokes told apart by a number:
//   idx, SPLINE_X, SPLINE_Y, SENSOR_TIMESTAMP (ms), SENSOR_PRESSURE, SENSOR_ALTITUDE, SENSOR_AZIMUTH
//   stroke, stroke_t0_unix_ms, t_rel_ms, x_px, y_px, pressure, altitude_rad, azimuth_rad
// Positions in pixels, y down; pressure 0 to 1; angles as in pen_lean.h.
#pragma once

#include <string_view>

#include "capture/import/recording.h"
#include "signal/result.h"
#include "signal/units.h"

namespace fude {

inline constexpr Millimetres default_mm_per_ink_pixel{25.4 / 96};

bool looks_like_wacom_ink_csv(std::string_view text);

// The pen touches in every row; where a stroke ends it leaves, at the time and place of the stroke's last
// row. Errors: malformed where a column or every row is missing; usage for a pixel not between 0.001 and 100
// mm.
Result<RawRecording> import_wacom_ink_csv(std::string_view text, Millimetres per_pixel);

}  // namespace fude
