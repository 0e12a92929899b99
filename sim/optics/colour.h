// From what lies on the paper to what is seen: the pigments of a cell form one mixed layer over the
// paper (Kubelka-Munk with K = Σ Kᵢxᵢ, S = Σ Sᵢxᵢ: Chu 3.12.3, Baxter 5.1), and its light becomes sRGB.
#pragma once

#include <span>
#include <vector>

#include "signal/ink_event.h"
#include "sim/optics/picture.h"
#include "sim/optics/pigment.h"

namespace fude {

// Raw Xuan on white felt: near white, faintly warm.
inline constexpr Bands xuan_reflectance = {0.925, 0.895, 0.825};

// The pigments of the channels, in their order, and the ground they lie on. At most three pigments:
// the fourth channel is glue, which is not seen. The ground is at least 0 and below 1.
struct Palette {
  std::vector<Pigment> pigments;
  Bands ground = xuan_reflectance;
};

// The reflectance of one cell that holds these amounts, in µl of full-strength ink per mm², at least 0.
Bands colour(const Concentrations& amounts_ul_per_mm2, const Palette& palette);

// A row of cells as pixels, rounded to the nearest code; `pixels` is as long as the row.
void colour_row(std::span<const Concentrations> amounts_ul_per_mm2, const Palette& palette,
                std::span<Rgb16> pixels);

}  // namespace fude
