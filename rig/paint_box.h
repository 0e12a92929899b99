// What a painter has beside the paper: the pigments of a picture, by name, and the wells, the cloth and the
// rim that the brush may go to. A palette of share/palettes (docs/performances.md).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "signal/ink_event.h"
#include "signal/result.h"
#include "sim/brush/dipping.h"
#include "sim/optics/pigment.h"

namespace fude {

// A round place. Millimetres from the lower left corner of the sheet: beside it, x is below 0 or beyond the
// width.
struct PlacedSpot {
  std::string name;
  double x_mm = 0;
  double y_mm = 0;
  double radius_mm = 0;
  PaletteSpot spot;
};

// The first of them whose circle holds the place; null where none does.
const PlacedSpot* spot_at(const std::vector<PlacedSpot>& spots, double x_mm, double y_mm);

struct PaintBox {
  std::string name;
  std::vector<Pigment> pigments;  // of the channels, in their order: one to three
  std::vector<PlacedSpot> spots;  // wells, then cloths, then rims
  std::string toml;               // what it was read from, for a session
};

// Errors: malformed, naming `source` and what is wrong; not_found for a pigment that there is not, listing
// those there are.
Result<PaintBox> read_paint_box(std::string_view toml, const std::string& source);

// The palette of that name in share/palettes, or of that file. Errors: not_found; those of read_paint_box.
Result<PaintBox> find_paint_box(const std::string& name);

}  // namespace fude
