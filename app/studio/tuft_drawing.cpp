#include "app/studio/tuft_drawing.h"

#include <imgui.h>

#include <utility>
#include <vector>

namespace fude {
namespace {

constexpr ImU32 shadow = IM_COL32(0, 0, 0, 60);
constexpr ImU32 hair = IM_COL32(60, 48, 40, 150);
constexpr ImU32 edge = IM_COL32(30, 22, 18, 220);

// A lamp at the upper left: what is a millimetre above the paper throws its shadow so far.
const Eigen::Vector2d shadow_per_mm(0.3, -0.2);
// Seen a little from the painter's side: height leans away.
const Eigen::Vector2d rise_per_mm(0, 0.25);

ImVec2 on_screen(const View& view, const Eigen::Vector3d& p, const Eigen::Vector2d& per_height) {
  const Eigen::Vector2d at = view.to_window(p.head<2>() + p.z() * per_height);
  return {static_cast<float>(at.x()), static_cast<float>(at.y())};
}

// Section by section from the root to the tip, as quadrilaterals across the tuft.
void fill(ImDrawList& canvas, const View& view, const TuftSurface& sections,
          const Eigen::Vector2d& per_height, ImU32 colour) {
  const auto side_a = [&](const Station& s) {
    return on_screen(view, s.centre + s.major_a * s.lateral, per_height);
  };
  const auto side_b = [&](const Station& s) {
    return on_screen(view, s.centre - s.major_b * s.lateral, per_height);
  };
  for (std::size_t i = 0; i + 1 < sections.size(); ++i)
    canvas.AddQuadFilled(side_a(sections[i]), side_a(sections[i + 1]), side_b(sections[i + 1]),
                         side_b(sections[i]), colour);
}

}  // namespace

void draw_tuft(ImDrawList& canvas, const View& view, const TuftShape& tuft) {
  // Smoothed edges would show as seams between the sections.
  const ImDrawListFlags flags = std::exchange(canvas.Flags, canvas.Flags & ~ImDrawListFlags_AntiAliasedFill);
  fill(canvas, view, tuft.sections, shadow_per_mm, shadow);
  fill(canvas, view, tuft.sections, rise_per_mm, hair);
  std::vector<ImVec2> spine;
  for (const Eigen::Vector3d& node : tuft.spine) spine.push_back(on_screen(view, node, rise_per_mm));
  if (spine.size() > 1)
    canvas.AddPolyline(spine.data(), static_cast<int>(spine.size()), edge, ImDrawFlags_None, 1.5F);
  canvas.Flags = flags;
}

}  // namespace fude
