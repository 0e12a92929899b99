#include "app/studio/panel.h"

#include <imgui.h>

#include <array>
#include <cmath>
#include <string>

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

// What the brush is loaded with.
void draw_colours(const std::vector<Pigment>& pigments, CareChoice& care) {
  for (std::size_t i = 0; i < pigments.size(); ++i)
    if (ImGui::RadioButton(std::string(pigments[i].name).c_str(), care.pigment == i)) care.pigment = i;
  ImGui::SliderFloat("strength", &care.strength, 0, 3);
  ImGui::SliderFloat("wetness", &care.wetness, 0, 1);
  ImGui::SliderFloat("dip, mm", &care.depth_mm, 0, 40);
}

}  // namespace

PanelChoice draw_panel(const LiveStatus& status, bool mouse, MousePen& mouse_pen, BrushDisplay& display,
                       double wet_step_budget_ms, const std::vector<Pigment>& pigments, CareChoice& care) {
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
  constexpr std::array<const char*, 4> looks = {"shaded", "colours", "outline", "off"};  // as TuftLook
  int look = static_cast<int>(display.look);
  if (ImGui::Combo("brush", &look, looks.data(), static_cast<int>(looks.size())))
    display.look = static_cast<TuftLook>(look);
  ImGui::Checkbox("development view", &display.development);
  const auto button = [&](const char* label, StudioKey key, bool enabled) {
    ImGui::BeginDisabled(!enabled);
    if (ImGui::Button(label)) choice.key = key;
    ImGui::EndDisabled();
  };
  button("Undo (Ctrl+Z)", StudioKey::undo, status.can_undo);
  ImGui::SameLine();
  button("Redo (Shift+Ctrl+Z)", StudioKey::redo, status.can_redo);
  draw_colours(pigments, care);
  button("Load (L)", StudioKey::load, true);
  ImGui::SameLine();
  button("Gradient (G)", StudioKey::gradient, true);
  ImGui::SameLine();
  button("Dip (I)", StudioKey::dip, true);
  button("Rinse (W)", StudioKey::rinse, true);
  ImGui::SameLine();
  button("Wipe (E)", StudioKey::wipe, true);
  ImGui::SameLine();
  button("Blot (B)", StudioKey::blot, true);
  ImGui::SameLine();
  button("Roll (O)", StudioKey::roll, true);
  button("Reshape (R)", StudioKey::reshape, true);
  ImGui::SameLine();
  button("Dry sheet (D)", StudioKey::dry, true);
  ImGui::SameLine();
  button("Fit (F)", StudioKey::fit, true);
  if (ImGui::Button("Save PNG (S)")) choice.save = true;
  ImGui::End();
  return choice;
}

}  // namespace fude
