#include "sim/brush/tuft.h"

#include <algorithm>

#include "signal/elementary.h"

namespace fude {

double rest_radius_mm(const BrushSpec& spec, double along) {
  const double u = std::clamp(along, 0.0, 1.0);
  if (u < spec.belly_at) {
    const double rise = 1 - u / spec.belly_at;
    return spec.belly_radius_mm + (spec.root_radius_mm - spec.belly_radius_mm) * rise * rise;
  }
  const double fall = (u - spec.belly_at) / (1 - spec.belly_at);
  return spec.tip_radius_mm +
         (spec.belly_radius_mm - spec.tip_radius_mm) * (1 - elementary::power(fall, spec.taper));
}

Tuft make_tuft(const BrushSpec& spec) {
  Tuft tuft;
  tuft.spec = spec;
  tuft.segments = static_cast<int>(spec.segments);
  const auto n = static_cast<std::size_t>(tuft.segments);
  double total = 0;
  double share = 1;
  for (std::size_t i = 0; i < n; ++i, share *= spec.segment_ratio) total += tuft.length_mm[i] = share;
  for (std::size_t i = 0; i < n; ++i) tuft.length_mm[i] *= spec.tuft_length_mm / total;

  double along_mm = 0;
  for (std::size_t i = 0; i <= n; ++i) {
    tuft.radius_mm[i] = rest_radius_mm(spec, along_mm / spec.tuft_length_mm);
    if (i < n) along_mm += tuft.length_mm[i];
  }
  double hanging_mm = spec.tuft_length_mm;
  for (std::size_t i = 0; i < n; ++i) {
    // A joint stands for half the segment above it and half the one below.
    const double span = i == 0 ? tuft.length_mm[0] : 0.5 * (tuft.length_mm[i - 1] + tuft.length_mm[i]);
    const double thinning = elementary::power(hanging_mm / spec.tuft_length_mm, spec.stiffness_fall);
    hanging_mm -= tuft.length_mm[i];
    tuft.bend_stiffness[i] = spec.bend_stiffness * thinning / span;
    const bool free = i == 0 && spec.spines == 1;  // a row keeps to its breadth
    tuft.twist_stiffness[i] = free ? 0 : spec.twist_ratio * tuft.bend_stiffness[i];
    if (spec.spines > 1) tuft.bend_stiffness[i] *= 1 + spec.row_coherence;
  }
  for (std::size_t k = 1; k < n; ++k)
    tuft.stretch_stiffness[k] =
        spec.stretch_stiffness *
        elementary::power(tuft.radius_mm[k] / spec.belly_radius_mm, spec.stiffness_fall);
  tuft.contact_share = spec.section_contact ? spec.contact_share : 0;
  return tuft;
}

}  // namespace fude
