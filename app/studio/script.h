// A window driven by a script: events of the mouse and the keyboard at stated times, as a hand would give
// them. Text, one event a line; `#` begins a comment. Places are millimetres on the paper.
//
//   SECONDS move X Y        SECONDS key NAME       (undo redo load gradient dip rinse wipe blot
//                                             roll reshape dry fit)
//   SECONDS press           SECONDS zoom FACTOR    (about the middle of the window)
//   SECONDS release         SECONDS save FILE      (the sheet as it stands, a PNG)
//   SECONDS pressure P      SECONDS shot FILE      (the window as it is seen, a PNG)
//   SECONDS look NAME       SECONDS quit           (shaded colours outline off development)
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "rig/brush_view/tuft_look.h"
#include "signal/result.h"

namespace fude {

enum class StudioKey { undo, redo, load, gradient, dip, rinse, wipe, blot, roll, reshape, dry, fit };

struct MoveTo {
  double x_mm;
  double y_mm;
};
struct Button {
  bool pressed;
};
struct Press {
  double pressure;
};
struct Zoom {
  double factor;
};
struct SaveAs {
  std::string file;
};
struct Shot {
  std::string file;
};
struct Look {
  TuftLook hair = TuftLook::shaded;
  bool development = false;
};
struct Quit {};

using StudioEvent = std::variant<MoveTo, Button, Press, Zoom, StudioKey, SaveAs, Shot, Look, Quit>;

struct ScriptedEvent {
  double at_s;
  StudioEvent what;
};

// In order of time. Errors: malformed, naming the line.
Result<std::vector<ScriptedEvent>> read_script(const std::string& text, const std::string& source);

}  // namespace fude
