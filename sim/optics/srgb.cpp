#include "sim/optics/srgb.h"

#include <algorithm>
#include <array>
#include <memory>

#include "signal/elementary.h"

namespace fude {
namespace {

constexpr std::size_t codes = 65536;
constexpr std::size_t bins = 4096;

struct CodeTable {
  std::array<double, codes> least;              // the least light that has this code
  std::array<std::uint16_t, bins + 2> first{};  // the code at the low end of each 1/4096 of light

  CodeTable() {
    least[0] = 0;
    for (std::size_t k = 1; k < codes; ++k)
      least[k] = linear_from_srgb((static_cast<double>(k) - 0.5) / (codes - 1));
    for (std::size_t bin = 0; bin < first.size(); ++bin) {
      const auto above = std::ranges::upper_bound(least, static_cast<double>(bin) / bins);
      first[bin] = static_cast<std::uint16_t>(above - least.begin() - 1);
    }
  }
};

}  // namespace

double srgb_from_linear(double linear) {
  const double x = std::clamp(linear, 0.0, 1.0);
  return x <= 0.0031308 ? 12.92 * x : 1.055 * elementary::power(x, 1 / 2.4) - 0.055;
}

double linear_from_srgb(double code) {
  const double x = std::clamp(code, 0.0, 1.0);
  return x <= 0.04045 ? x / 12.92 : elementary::power((x + 0.055) / 1.055, 2.4);
}

std::uint16_t srgb16_from_linear(double linear) {
  static const auto table = std::make_unique<const CodeTable>();
  const double x = std::clamp(linear, 0.0, 1.0);
  const auto bin = static_cast<std::size_t>(x * bins);
  const double* low = table->least.data() + table->first[bin];
  const double* high = table->least.data() + table->first[bin + 1] + 1;
  return static_cast<std::uint16_t>(std::upper_bound(low, high, x) - table->least.data() - 1);
}

}  // namespace fude
