// A brush over the paper as the painter sees it: in perspective, with its footprint and its shadow. Drawn by
// the processor, so that it needs neither window nor graphics card.
#pragma once

#include <span>
#include <vector>

#include "rig/brush_view/posed_brush.h"
#include "rig/brush_view/tuft_look.h"
#include "sim/optics/colour.h"
#include "sim/optics/picture.h"

namespace fude {

struct PictureWish {
  int width = 900;
  int height = 700;
  TuftLook look = TuftLook::shaded;
  double opacity = 0.86;  // of the hair: the footprint shows through
  Palette palette{{pigments()[0]}, xuan_reflectance};
};

// The tuft of a brush as it stands, with its ink.
std::vector<SeenTuft> seen_tufts(const Brush& brush);

// One brush. The picture takes in the tuft and what it left.
Picture picture_of(const PosedBrush& posed, const PictureWish& wish);

// Several beside each other, three to a row, in their order.
Picture contact_sheet(std::span<const Picture> pictures);

}  // namespace fude
