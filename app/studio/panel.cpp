#include "app/studio/panel.h"

#include <imgui.h>

#include <cmath>

namespace fude {
namespace {

void draw_tilt(const PenSample& pen) {
  if (!pen.tilt_x || !pen.tilt_y) {
    ImGui::TextUnformatted("tilt      not sensed");
    return;
  }
  ImGui::Text("tilt      %+.0f, %+.0f deg", in_degrees(*pen.tilt_x), in_degrees(*pen.tilt_y));
  if (pen.rotation) ImGui::Text("rotation  %+.0f deg", in_degrees(*pen.rotation));
  // A dial: where the pen's upper end leans.
  const float radius = 28;
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const ImVec2 centre(corner.x + radius, corner.y + radius);
  ImDrawList& canvas = *ImGui::GetWindowDrawList();
  canvas.AddCircle(centre, radius, IM_COL32(90, 90, 90, 255));
  const auto lean = [&](Radians tilt) { return radius * static_cast<float>(std::sin(tilt.value)); };
  canvas.AddLine(centre, ImVec2(centre.x + lean(*pen.tilt_x), centre.y + lean(*pen.tilt_y)),
                 IM_COL32(20, 20, 20, 255), 3);
  ImGui::Dummy(ImVec2(2 * radius, 2 * radius));
}

}  // namespace

PanelChoice draw_panel(const LiveStatus& status, bool mouse, MousePen& mouse_pen, double wet_step_budget_ms) {
  PanelChoice choice;
  ImGui::SetNextWindowPos(ImVec2(12, 12), ImGuiCond_FirstUseEver);
  ImGui::Begin("fude", nullptr, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse);
  ImGui::Text("pen       %s", mouse ? "mouse (no pressure, no tilt)" : "tablet");
  ImGui::Text("pressure  %.2f", status.pen.pressure.value);
  ImGui::SameLine();
  ImGui::ProgressBar(static_cast<float>(status.pen.pressure.value), ImVec2(120, 0), "");
  draw_tilt(status.pen);
  ImGui::Text("at        %.1f, %.1f mm", status.nib_mm.x(), status.nib_mm.y());
  ImGui::Text("ink step  %.2f ms of %.1f", status.step_ms, wet_step_budget_ms);
  ImGui::Text("latency   %.1f ms", status.latency_ms);
  if (mouse) {
    auto pressure = static_cast<float>(mouse_pen.pressure);
    if (ImGui::SliderFloat("mouse pressure", &pressure, 0.05F, 1))
      mouse_pen.pressure = static_cast<double>(pressure);
  }
  const auto button = [&](const char* label, StudioKey key, bool enabled) {
    ImGui::BeginDisabled(!enabled);
    if (ImGui::Button(label)) choice.key = key;
    ImGui::EndDisabled();
  };
  button("Undo (Ctrl+Z)", StudioKey::undo, status.can_undo);
  ImGui::SameLine();
  button("Redo (Shift+Ctrl+Z)", StudioKey::redo, status.can_redo);
  button("Load ink (L)", StudioKey::load, true);
  ImGui::SameLine();
  button("Reshape (R)", StudioKey::reshape, true);
  button("Dry sheet (D)", StudioKey::dry, true);
  ImGui::SameLine();
  button("Fit (F)", StudioKey::fit, true);
  if (ImGui::Button("Save PNG (S)")) choice.save = true;
  ImGui::End();
  return choice;
}

}  // namespace fude
