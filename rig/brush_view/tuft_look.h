// What a tuft looks like: its surface as shaded triangles, its rim, and its shadow on the paper.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "rig/brush_view/projection.h"
#include "signal/ink_event.h"
#include "sim/brush/tuft_surface.h"
#include "sim/optics/colour.h"
#include "sim/optics/triangle_layer.h"

namespace fude {

enum class TuftLook {
  shaded,   // bare hair
  colours,  // with the ink that it carries
  outline,  // the rim alone
  off
};

// A tuft to be drawn. `loads` are of its patches (loading.h); empty: bare hair.
struct SeenTuft {
  TuftSurface surface;
  std::vector<InkLoad> loads;
};

// Where a lamp at the upper left throws the shadow of what is a millimetre above the paper.
inline const Eigen::Vector2d shadow_per_mm(0.3, -0.2);

// One layer a tuft, each as opaque as `opacity`; none for TuftLook::off. What is under the paper is drawn
// upon it. `palette` tells the colours of the pigments; its ground is not used.
std::vector<TriangleLayer> tuft_layers(std::span<const SeenTuft> tufts, TuftLook look, double opacity,
                                       const Palette& palette, const Projection& projection,
                                       const PixelBox& picture, int samples_per_side);

// The shadows of all, softer the higher they hang: a few layers that blend. They lie on the paper, and under
// the tufts.
std::vector<TriangleLayer> shadow_layers(std::span<const SeenTuft> tufts, const Projection& projection,
                                         const PixelBox& picture, int samples_per_side);

}  // namespace fude
