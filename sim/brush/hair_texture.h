// Which of the tuft's hair leaves ink: two maps over its surface, of strands that run along it.
//
// The dry map (Chu 2.7.1) is the height of the bristles: as a tuft dries, the lower ones leave nothing, and
// pressure brings them back. The split map (2.4.3) is where the hair parts: lines between locks of hair that
// widen as the tuft spreads and dries; a soaked tip moves them on beyond its end (2.7.2).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim/brush/brush_spec.h"

namespace fude {

class HairTexture {
 public:
  // The same seed gives the same hair.
  HairTexture(const BrushSpec& spec, std::uint64_t seed);

  // Share of the bristles that reach the paper, the highest first, at a wetness (0 dry to 1 full) and under a
  // pressure along the tuft. 1 from `streak_wetness` on.
  float reach(float wetness, double press_mn_mm) const;

  // How far splits are open, 0 to 1, where a section is wider than round by `spread` (HairState).
  float opening(float wetness, double spread) const;

  // By how much the split map of a tuft whose tip is so wet is moved on, of the tuft's length.
  float split_shift(float tip_wetness) const;

  // Share of the hair at `along` (0 root to 1 tip) and `around` (turns from the lateral line, not below 0)
  // that leaves ink, where so many bristles reach the paper and splits are open so far.
  float inked(float along, float around, float reach, float opening, float split_shift) const {
    const float turn = around - static_cast<float>(static_cast<int>(around));
    const auto column = std::min(static_cast<std::size_t>(turn * static_cast<float>(columns_)), columns_ - 1);
    const float dry = static_cast<float>(strands_[column + columns_ * level_at(along)].lower);
    const float parts =
        static_cast<float>(strands_[column + columns_ * level_at(along - split_shift)].parts_at);
    return std::clamp((reach * (1 + edge) - dry / 256) / edge, 0.0F, 1.0F) *
           std::clamp(1 - (opening - parts / 256) / edge, 0.0F, 1.0F);
  }

  // Share of a sheet's hills that bristles touch, where so many of them reach it (Chu 2.7.3).
  float hills(float reach) const { return 1 - grain_ * (1 - reach); }
  // What they leave at this height (PaperGrain).
  static float grained(float hills, float height) {
    return std::clamp((hills * (1 + edge) - (1 - height)) / edge, 0.0F, 1.0F);
  }
  bool grained() const { return grain_ > 0; }

 private:
  static constexpr float edge = 0.12F;  // over which a strand fades
  static constexpr std::size_t levels = 96;

  // Both in 256ths.
  struct Strand {
    std::uint8_t lower = 0;     // share of the hair that stands higher
    std::uint8_t parts_at = 0;  // opening at which it parts
  };
  static std::size_t level_at(float along) {
    return static_cast<std::size_t>(
        std::clamp(along * static_cast<float>(levels), 0.0F, static_cast<float>(levels - 1)));
  }
  void grow_bristles(std::uint64_t seed);
  void part(const BrushSpec& spec, std::uint64_t seed);

  std::size_t columns_;
  float streak_wetness_;
  double streak_press_;
  double streak_half_;
  float split_open_;
  float split_shift_;
  float grain_;
  std::vector<Strand> strands_;  // levels from root to tip, columns around
};

}  // namespace fude
