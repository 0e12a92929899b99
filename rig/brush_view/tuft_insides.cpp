#include "rig/brush_view/tuft_insides.h"

namespace fude {

TuftInsides insides_of(const Brush& brush) {
  constexpr double half_mm = 3;  // of a plane, as it is drawn
  TuftInsides insides;
  const BrushShape shape = brush.shape();
  for (std::size_t i = 0; i < shape.size(); ++i) {
    const TuftState& state = brush.state().tufts[i].state;
    for (std::size_t k = 0; k < shape[i].spine.size(); ++k) {
      const std::array nodes{shape[i].spine[k], shape[i].lateral_a[k], shape[i].lateral_b[k]};
      for (std::size_t side = 0; side < nodes.size(); ++side)
        if (const Touch& touch = state.touches[k][side]; touch.touching)
          insides.contacts.push_back({nodes[side], touch.anchor});
    }
    if (const BlockingPlane& plane = state.plane; plane.stands) {
      const Eigen::Vector2d middle = plane.stuck + plane.lead_mm * plane.facing;
      const Eigen::Vector2d along(-plane.facing.y(), plane.facing.x());
      insides.planes.push_back({middle - half_mm * along, middle + half_mm * along});
    }
  }
  return insides;
}

}  // namespace fude
