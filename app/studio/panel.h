// The panel beside the paper: what the pen does, how the ink keeps up, and the painter's commands.
#pragma once

#include <optional>

#include "app/studio/mouse_pen.h"
#include "app/studio/script.h"
#include "rig/live_painting.h"

namespace fude {

struct PanelChoice {
  std::optional<StudioKey> key;
  bool save = false;
};

// Draws it and says what was chosen; moves the mouse pen's pressure. `mouse`: the pen shown is the mouse.
PanelChoice draw_panel(const LiveStatus& status, bool mouse, MousePen& mouse_pen, double wet_step_budget_ms);

}  // namespace fude
