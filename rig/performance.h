// A scripted performance: strokes written as the motion of a pen in millimetres, its lean and pressure
// over time, played into a tablet that does not exist. What comes out are the events such a tablet
// would send, so the real driver's decoding makes the session.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "calibration/pen_mapping.h"
#include "capture/import/recording.h"
#include "rig/paint_box.h"
#include "signal/action.h"
#include "signal/result.h"
#include "signal/units.h"

namespace fude {

// A point that the pen passes. The sheet's millimetres: x right, y up, origin lower left.
struct PerformedKnot {
  double x_mm = 0;
  double y_mm = 0;
  double pressure = 0;           // 0 to 1
  std::optional<double> beat_s;  // the hand comes to rest here, this long after the rest before
};

struct PerformedStroke {
  std::string name;
  std::vector<PerformedKnot> knots;  // two at least; the last is a beat, as the first
  Radians tilt_x;
  Radians tilt_y;
  double rest_s = 0.3;                          // in the air before it
  std::vector<decltype(Action::what)> prepare;  // done to the brush first, in this order
};

struct Performance {
  std::string name;
  double rate_hz = 200;
  Millimetres width;
  Millimetres height;
  std::optional<PaintBox> palette;  // none: ink alone
  std::optional<Extent> sheet;      // in the middle of the tablet; none: as large as that
  std::vector<PerformedStroke> strokes;
};

// From TOML (docs/performances.md). Errors: malformed, naming `source` and the stroke; those of
// find_paint_box.
Result<Performance> read_performance(std::string_view toml, const std::string& source);

struct Performed {
  RawRecording recording;
  std::vector<Action> actions;
};

// Between two beats the hand moves as hands do when they reach: least jerk, a bell of speed (Flash and
// Hogan 1985); position along a centripetal Catmull-Rom curve, pressure monotone between the knots.
Performed perform(const Performance& performance);

// The performance as a session, with its palette. Errors: as import_session.
Result<void> write_performance(const Performance& performance, const std::filesystem::path& session,
                               bool overwrite);

}  // namespace fude
