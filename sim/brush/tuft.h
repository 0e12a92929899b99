// The tuft at rest: what BrushSpec says, cut into segments and springs (Chu 2.4, 2.5.4).
// Joint i stands at the head of segment i; node i at the head of segment i, node n at the tip.
#pragma once

#include <array>

#include "sim/brush/brush_spec.h"

namespace fude {

inline constexpr int max_segments = 8;

template <class T>
using PerSegment = std::array<T, max_segments>;
template <class T>
using PerNode = std::array<T, max_segments + 1>;

struct Tuft {
  BrushSpec spec;
  int segments = 0;
  PerSegment<double> length_mm{};       // progressively shorter towards the tip
  PerNode<double> radius_mm{};          // initial tuft radius
  PerSegment<double> bend_stiffness{};  // mN·mm, of the joint's bend spring and that towards its neighbours'
  PerSegment<double> twist_stiffness{};  // mN·mm; 0 at the root of a round tuft
  PerNode<double> stretch_stiffness{};   // mN/mm, of each lateral node's spring
  double contact_share = 0;              // Φ over Ω; 0 where only the spine is stopped
};

Tuft make_tuft(const BrushSpec& spec);

// Initial tuft radius in mm at `along`, 0 root to 1 tip.
double rest_radius_mm(const BrushSpec& spec, double along);

}  // namespace fude
