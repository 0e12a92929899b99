#include "sim/optics/colour.h"

#include <stdexcept>

#include "sim/optics/kubelka_munk.h"
#include "sim/optics/srgb.h"

namespace fude {
namespace {

Rgb16 pixel_of(const Bands& linear) {
  return {srgb16_from_linear(linear[0]), srgb16_from_linear(linear[1]), srgb16_from_linear(linear[2])};
}

}  // namespace

Bands colour(const Concentrations& amounts_ul_per_mm2, const Palette& palette) {
  Bands absorption{};
  Bands scattering{};
  for (std::size_t i = 0; i < palette.pigments.size(); ++i) {
    const double layers = static_cast<double>(amounts_ul_per_mm2[i]) / unit_layer_ul_per_mm2;
    for (std::size_t band = 0; band < absorption.size(); ++band) {
      absorption[band] += palette.pigments[i].absorption[band] * layers;
      scattering[band] += palette.pigments[i].scattering[band] * layers;
    }
  }
  Bands seen{};
  for (std::size_t band = 0; band < seen.size(); ++band)
    seen[band] = reflectance_over(layer_optics(absorption[band], scattering[band]), palette.ground[band]);
  return seen;
}

void colour_row(std::span<const Concentrations> amounts_ul_per_mm2, const Palette& palette,
                std::span<Rgb16> pixels) {
  if (pixels.size() != amounts_ul_per_mm2.size() || palette.pigments.size() > glue_channel)
    throw std::invalid_argument("colour_row: a pixel for each cell, and at most three pigments");
  // Neighbours are often alike: blank paper, flat washes.
  Concentrations last{};
  Rgb16 seen = pixel_of(colour(last, palette));
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (amounts_ul_per_mm2[i] != last) {
      last = amounts_ul_per_mm2[i];
      seen = pixel_of(colour(last, palette));
    }
    pixels[i] = seen;
  }
}

}  // namespace fude
