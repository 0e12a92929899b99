// Pigments as data: how strongly a unit layer of each absorbs and scatters in the three bands.
#pragma once

#include <array>
#include <span>
#include <string_view>

#include "signal/result.h"

namespace fude {

// Red, green, blue: linear light in the primaries of sRGB, 0 to 1 where it is a reflectance.
using Bands = std::array<double, 3>;

// The amount of full-strength ink on which K and S are stated: what fills a fresh sheet of Xuan once.
inline constexpr double unit_layer_ul_per_mm2 = 0.1;

struct Pigment {
  std::string_view name;
  Bands absorption{};
  Bands scattering{};
};

// The rows of pigments.inl; the first is Chinese ink.
std::span<const Pigment> pigments();

// Errors: not_found, listing the names there are.
Result<Pigment> find_pigment(std::string_view name);

}  // namespace fude
