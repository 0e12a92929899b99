// What the painter did besides moving the brush. Each is applied between two ink steps, and the
// session keeps at which, so that painting live and replaying give the same picture.
#pragma once

#include <string>
#include <variant>

#include "signal/ink_event.h"
#include "signal/timestamp.h"

namespace fude {

// Dip the brush: fill it to `wetness` (0 to 1 of its capacity) with ink of these strengths.
struct LoadBrush {
  float wetness = 1;
  Concentrations strength{};
  bool operator==(const LoadBrush&) const = default;
};

// Bring the tuft back to its unbent form.
struct ReshapeBrush {
  bool operator==(const ReshapeBrush&) const = default;
};

// Dry the sheet at once.
struct DrySheet {
  bool operator==(const DrySheet&) const = default;
};

// Take back the last stroke or action, or bring back what was taken back.
struct Undo {
  bool operator==(const Undo&) const = default;
};
struct Redo {
  bool operator==(const Redo&) const = default;
};

struct Action {
  Timestamp time{};
  std::variant<LoadBrush, ReshapeBrush, DrySheet, Undo, Redo> what;
  bool operator==(const Action&) const = default;
};

}  // namespace fude
