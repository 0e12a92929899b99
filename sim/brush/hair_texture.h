// Streaks of a drying tuft: hair bundles around the tuft run dry one after the other, each in its own
// places along its length (a plain form of the dry map of Chu 2.7.1).
#pragma once

#include <cstdint>
#include <vector>

#include "sim/brush/brush_spec.h"

namespace fude {

class HairTexture {
 public:
  // The same seed gives the same hair.
  HairTexture(const BrushSpec& spec, std::uint64_t seed);

  // Below it streaks open.
  double streak_wetness() const { return streak_wetness_; }

  // Share of the hair at (along, around in turns from the lateral line, not below −1) that still leaves ink
  // at this wetness: 1 for a wet tuft, falling to 0 bundle by bundle below `streak_wetness`.
  double inked(double along, double around, double wetness) const;

 private:
  int bundles_;
  double streak_wetness_;
  std::vector<float> dries_at_;  // bundles × levels: the share of streak_wetness at which it runs dry
};

}  // namespace fude
