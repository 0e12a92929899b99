// The panel beside the paper: what the pen does, how the ink keeps up, and the painter's commands.
#pragma once

#include <optional>
#include <vector>

#include "app/studio/care_choice.h"
#include "app/studio/mouse_pen.h"
#include "app/studio/script.h"
#include "app/studio/tuft_drawing.h"
#include "rig/live_painting.h"
#include "sim/optics/pigment.h"

namespace fude {

struct PanelChoice {
  std::optional<StudioKey> key;
  bool save = false;
};

// Draws it and says what was chosen; changes the mouse pen's pressure, how the brush is displayed, and what
// it is loaded with, of these pigments. `mouse`: the pen shown is the mouse.
PanelChoice draw_panel(const LiveStatus& status, bool mouse, MousePen& mouse_pen, BrushDisplay& display,
                       double wet_step_budget_ms, const std::vector<Pigment>& pigments, CareChoice& care);

}  // namespace fude
