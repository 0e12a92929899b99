// The scale of sRGB (IEC 61966-2-1): linear light and its code, both 0 to 1; what lies outside is clamped.
#pragma once

#include <cstdint>

namespace fude {

double srgb_from_linear(double linear);
double linear_from_srgb(double code);

// The nearest of the 65536 codes, found in a table of the light between them: three times faster.
std::uint16_t srgb16_from_linear(double linear);

}  // namespace fude
