#include "rig/inputs.h"

#include <algorithm>
#include <cmath>

#include "rig/session_summary.h"

namespace fude {

Step step_at(Duration since_start, double step_s) {
  return std::max<Step>(0, static_cast<Step>(std::floor(seconds(since_start) / step_s)));
}

BrushMove brush_move(const PenSample& pen, const TabletMapping& mapping, const PenReach& reach) {
  return {pen.tool == PenTool::rubber ? PenEnd::rubber : PenEnd::tip, brush_input(pen, mapping, reach)};
}

std::vector<TimedInput> inputs_of(const Session& session, const SheetPlan& plan, const PenReach& reach,
                                  double step_s) {
  const Timestamp start = span_of(session).first;
  std::vector<TimedInput> inputs;
  auto pen = session.pens.begin();
  auto action = session.actions.begin();
  Step reached = 0;
  HeldPens held(plan.manner, plan.sheet);
  const auto add = [&](std::optional<Step> applied, Timestamp time, PaintingInput input) {
    reached = std::max(reached, applied ? *applied : step_at(time - start, step_s));
    inputs.push_back({reached, std::move(input)});
  };
  while (pen != session.pens.end() || action != session.actions.end()) {
    if (action == session.actions.end() || (pen != session.pens.end() && pen->order < action->order)) {
      if (const auto mapping = plan.mappings.find(pen->device); mapping != plan.mappings.end())
        add(pen->applied, pen->sample.time.host,
            brush_move(held.held(pen->device, pen->sample, mapping->second), mapping->second, reach));
      ++pen;
    } else {
      add(action->applied, action->action.time, action->action);
      ++action;
    }
  }
  return inputs;
}

}  // namespace fude
