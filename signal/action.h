// What the painter did besides moving the brush. Each is applied between two ink steps, and the
// session keeps at which, so that painting live and replaying give the same picture.
#pragma once

#include <cstddef>
#include <optional>
#include <variant>
#include <vector>

#include "signal/ink_event.h"
#include "signal/timestamp.h"

namespace fude {

// Fill the brush to `wetness` (0 to 1 of its capacity) with ink of these strengths.
struct LoadBrush {
  float wetness = 1;
  Concentrations strength{};
  bool operator==(const LoadBrush&) const = default;
};

// One place of a gradient.
struct LoadStop {
  float along = 0;  // 0 root to 1 tip
  float wetness = 1;
  Concentrations strength{};
  bool operator==(const LoadStop&) const = default;
};
inline constexpr std::size_t most_stops = 64;  // of one side

// Fill the brush by ramps (Chu 2.6): along the tuft from stop to stop in a straight line, beyond the first
// and the last as there. `far_side`: likewise on the other side of the brush, and across it from one to the
// other in a straight line; empty: as this side. Stops lie in the order of `along`.
struct GradeBrush {
  std::vector<LoadStop> side;
  std::vector<LoadStop> far_side;
  bool operator==(const GradeBrush&) const = default;
};

// Hold the brush upright in ink of these strengths, its tip `depth_mm` below the surface.
struct DipBrush {
  float depth_mm = 0;
  float seconds = 0;
  Concentrations strength{};
  bool operator==(const DipBrush&) const = default;
};

// Swish the whole brush in clear water.
struct RinseBrush {
  float seconds = 0;
  bool operator==(const RinseBrush&) const = default;
};

// Stroke the brush off on a rim: no part stays fuller than `fullest` (0 to 1), and the tuft is straight.
struct WipeBrush {
  float fullest = 0.6F;
  bool operator==(const WipeBrush&) const = default;
};

// Hold a side of the brush against a dry cloth. `side`: where it touches, in turns about the tuft from its
// lateral line; none: all around.
struct BlotBrush {
  float seconds = 0;
  std::optional<float> side;
  bool operator==(const BlotBrush&) const = default;
};

// Roll the brush on the palette: its sides mix.
struct RollBrush {
  float turns = 1;
  bool operator==(const RollBrush&) const = default;
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

// What changes the ink in the brush.
using BrushCare = std::variant<LoadBrush, GradeBrush, DipBrush, RinseBrush, WipeBrush, BlotBrush, RollBrush>;

struct Action {
  Timestamp time{};
  std::variant<BrushCare, ReshapeBrush, DrySheet, Undo, Redo> what;
  bool operator==(const Action&) const = default;
};

}  // namespace fude
