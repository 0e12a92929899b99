#include "sim/brush/hair_texture.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace fude {
namespace {

constexpr int levels = 24;           // along a bundle
constexpr double edge = 0.12;        // wetness over which one bundle fades, of streak_wetness
constexpr int bundles_in_clump = 5;  // wet hair sticks together
constexpr double share_of_clump = 0.45;
constexpr double share_of_bundle = 0.35;  // the rest differs along it

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
    : bundles_(static_cast<int>(spec.hair_count)),
      streak_wetness_(spec.hair_texture ? spec.streak_wetness : 0) {
  std::uint64_t state = seed;
  std::vector<double> dryness;
  dryness.reserve(static_cast<std::size_t>(bundles_ * levels));
  double clump = 0;
  for (int b = 0; b < bundles_; ++b) {
    if (b % bundles_in_clump == 0) clump = uniform(state);
    const double own = uniform(state);
    double walk = uniform(state);
    for (int level = 0; level < levels; ++level) {
      walk = 0.8 * walk + 0.2 * uniform(state);
      dryness.push_back(share_of_clump * clump + share_of_bundle * own +
                        (1 - share_of_clump - share_of_bundle) * walk);
    }
  }
  // Ranks in place of values: half as wet, half as much hair leaves ink.
  std::vector<std::size_t> order(dryness.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t i, std::size_t j) { return dryness[i] < dryness[j]; });
  dries_at_.resize(dryness.size());
  for (std::size_t rank = 0; rank < order.size(); ++rank)
    dries_at_[order[rank]] =
        static_cast<float>(static_cast<double>(rank) / static_cast<double>(order.size()));
}

double HairTexture::inked(double along, double around, double wetness) const {
  if (wetness >= streak_wetness_) return 1;
  const double within = around + 1 - static_cast<double>(static_cast<int>(around + 1));
  const int bundle = std::clamp(static_cast<int>(within * bundles_), 0, bundles_ - 1);
  const int level = std::clamp(static_cast<int>(along * levels), 0, levels - 1);
  const double dry = static_cast<double>(dries_at_[static_cast<std::size_t>(bundle * levels + level)]);
  return std::clamp((wetness / streak_wetness_ * (1 + edge) - dry) / edge, 0.0, 1.0);
}

}  // namespace fude
