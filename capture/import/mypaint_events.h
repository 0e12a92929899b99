// Strokes as libmypaint's event files hold them: one row a sample, four fields between blanks:
//   seconds  x  y  pressure        x, y in pixels, y down; pressure 0 to 1, 0 while hovering
#pragma once

#include <string_view>

#include "capture/import/recording.h"
#include "signal/result.h"
#include "signal/units.h"

namespace fude {

inline constexpr Millimetres default_mm_per_pixel{0.1};

bool looks_like_mypaint_events(std::string_view text);

// Every row becomes a sample of a pen always in proximity, in contact where its pressure is above 0.
// Errors: malformed, with the line number: a field that is no number, a pressure outside 0 to 1, a
// position beyond a million pixels, time that runs backwards or never moves; usage for a pixel that
// is not between 0.001 and 100 mm.
Result<RawRecording> import_mypaint_events(std::string_view text, Millimetres per_pixel);

}  // namespace fude
