// A session's inputs in their order, each with the step at which it is applied.
#pragma once

#include <vector>

#include "capture/session.h"
#include "rig/history.h"
#include "rig/sheet_plan.h"

namespace fude {

struct TimedInput {
  Step step = 0;
  PaintingInput input;
};

// Inputs that were applied live keep their step; the others get the step their time falls in. Steps
// never go back: time that stands still or runs backwards is applied at the step reached.
std::vector<TimedInput> inputs_of(const Session& session, const SheetPlan& plan, const PenReach& reach,
                                  double step_s);

// The pen sample as the painting takes it.
BrushMove brush_move(const PenSample& pen, const TabletMapping& mapping, const PenReach& reach);

// The step that a time falls in, counted from the start of the session.
Step step_at(Duration since_start, double step_s);

}  // namespace fude
