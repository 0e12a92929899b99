#include "sim/brush/hair_texture.h"

#include <array>
#include <cmath>

#include "signal/elementary.h"

namespace fude {
namespace {

constexpr std::size_t strands_in_bundle = 4;

// SplitMix64 (Steele, Lea, Flood 2014).
std::uint64_t next(std::uint64_t& state) {
  std::uint64_t z = state += 0x9e3779b97f4a7c15ULL;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}
double uniform(std::uint64_t& state) { return static_cast<double>(next(state) >> 11) * 0x1p-53; }

}  // namespace

HairTexture::HairTexture(const BrushSpec& spec, std::uint64_t seed)
    : columns_(strands_in_bundle * static_cast<std::size_t>(spec.hair_count)),
      streak_wetness_(spec.hair_texture ? static_cast<float>(spec.streak_wetness) : 0),
      streak_press_(spec.streak_press),
      streak_half_(spec.streak_half_mn_mm),
      split_open_(spec.split_map ? static_cast<float>(spec.split_open) : 0),
      split_shift_(static_cast<float>(spec.split_shift_mm / spec.tuft_length_mm)),
      grain_(spec.grain_mask ? static_cast<float>(spec.grain) : 0),
      strands_(levels * columns_) {
  grow_bristles(seed);
  part(spec, seed ^ 0x73706c6974ULL);
}

// Locks of hair that stick together, bundles in them, and single strands; each stands higher and lower along
// its length. Ranks in place of heights: half as wet, half as much hair leaves ink.
void HairTexture::grow_bristles(std::uint64_t seed) {
  constexpr double of_lock = 0.4;
  constexpr double of_bundle = 0.3;
  constexpr double of_strand = 0.3;
  constexpr double keeps = 0.93;  // from level to level
  std::uint64_t state = seed;
  std::vector<float> lower(strands_.size());
  std::size_t lock_ends = 0;
  std::array<double, levels> lock{};
  std::array<double, levels> bundle{};
  const auto walk = [&](std::array<double, levels>& heights) {
    double height = uniform(state);
    for (double& h : heights) h = height = keeps * height + (1 - keeps) * uniform(state);
    // A walk keeps near its middle: drawn out again.
    const double own = uniform(state);
    for (double& h : heights) h = own + 0.8 * (h - 0.5);
  };
  for (std::size_t column = 0; column < columns_; ++column) {
    if (column >= lock_ends) {
      lock_ends = column + strands_in_bundle * (2 + static_cast<std::size_t>(7 * uniform(state)));
      walk(lock);
    }
    if (column % strands_in_bundle == 0) walk(bundle);
    std::array<double, levels> strand;
    walk(strand);
    for (std::size_t level = 0; level < levels; ++level)
      lower[column + columns_ * level] =
          static_cast<float>(of_lock * lock[level] + of_bundle * bundle[level] + of_strand * strand[level]);
  }
  constexpr std::size_t bins = 4096;
  const auto bin = [](float value) {
    return static_cast<std::size_t>(std::clamp((value + 1) / 3, 0.0F, 0.999F) * bins);
  };
  std::vector<std::size_t> below(bins + 1);
  for (const float value : lower) ++below[bin(value) + 1];
  for (std::size_t i = 0; i < bins; ++i) below[i + 1] += below[i];
  for (std::size_t i = 0; i < lower.size(); ++i)
    strands_[i].lower = static_cast<std::uint8_t>(below[bin(lower[i])] * 256 / (lower.size() + 1));
}

// Lines between locks of hair: each begins somewhere along the tuft, wanders a little, widens towards the tip
// and opens in its turn.
void HairTexture::part(const BrushSpec& spec, std::uint64_t seed) {
  constexpr double bundles_between = 4;
  constexpr double widest = 0.6;  // of the way between two lines
  for (Strand& strand : strands_) strand.parts_at = 255;
  std::uint64_t state = seed;
  const auto count = static_cast<std::size_t>(std::max(3.0, spec.hair_count / bundles_between));
  const double spacing = static_cast<double>(columns_) / static_cast<double>(count);
  for (std::size_t line = 0; line < count; ++line) {
    double column = (static_cast<double>(line) + uniform(state)) * spacing;
    const double begins = 0.15 + 0.75 * uniform(state);
    const double opens_at = 0.03 + 0.9 * uniform(state) * uniform(state);
    const double full_width = widest * spacing * (0.3 + uniform(state));
    double drift = 0;
    for (std::size_t level = 0; level < levels; ++level) {
      drift = 0.9 * drift + 0.12 * (uniform(state) - 0.5);
      column += drift;
      const double along = static_cast<double>(level) / levels;
      if (along <= begins) continue;
      const double half = 0.5 * full_width * std::min(1.0, (along - begins) / 0.25);
      for (int i = -static_cast<int>(half) - 1; i <= static_cast<int>(half) + 1; ++i) {
        const double at = std::floor(column) + i;
        const double distance = std::abs(at + 0.5 - column) / std::max(half, 0.5);
        if (distance > 1) continue;
        const double parts_at = opens_at + (1 - opens_at) * distance;
        const double wrapped =
            at - std::floor(at / static_cast<double>(columns_)) * static_cast<double>(columns_);
        Strand& strand =
            strands_[std::min(static_cast<std::size_t>(wrapped), columns_ - 1) + columns_ * level];
        strand.parts_at = std::min(strand.parts_at, static_cast<std::uint8_t>(255 * parts_at));
      }
    }
  }
}

float HairTexture::reach(float wetness, double press_mn_mm) const {
  if (wetness >= streak_wetness_) return 1;
  if (wetness <= 0) return 0;
  const double firm = streak_press_ * press_mn_mm / (press_mn_mm + streak_half_);
  const auto share = static_cast<double>(wetness / streak_wetness_);
  return static_cast<float>(elementary::exponential((1 - firm) * elementary::logarithm(share)));
}

float HairTexture::opening(float wetness, double spread) const {
  constexpr float clings = 0.9F;  // wetness at which hair does
  const float dryness = std::clamp(1 - wetness / clings, 0.0F, 1.0F);
  return split_open_ * dryness * static_cast<float>(std::min(1.0, spread));
}

float HairTexture::split_shift(float tip_wetness) const {
  constexpr float drained = 0.4F;
  return split_shift_ * std::clamp((tip_wetness - drained) / (1 - drained), 0.0F, 1.0F);
}

}  // namespace fude
