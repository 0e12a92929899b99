// Units as types: a length in millimetres cannot be handed over where radians are expected.
// Solvers use plain numbers inside, with the unit in the name (`depth_mm`, `dt_s`).
#pragma once

#include <compare>
#include <numbers>

namespace fude {

template <class Unit>
struct Quantity {
  double value = 0;

  constexpr Quantity() = default;
  constexpr explicit Quantity(double v) : value(v) {}

  constexpr auto operator<=>(const Quantity&) const = default;
  constexpr Quantity operator-() const { return Quantity(-value); }
  friend constexpr Quantity operator+(Quantity a, Quantity b) { return Quantity(a.value + b.value); }
  friend constexpr Quantity operator-(Quantity a, Quantity b) { return Quantity(a.value - b.value); }
  friend constexpr Quantity operator*(Quantity a, double s) { return Quantity(a.value * s); }
  friend constexpr Quantity operator*(double s, Quantity a) { return Quantity(a.value * s); }
  friend constexpr Quantity operator/(Quantity a, double s) { return Quantity(a.value / s); }
  friend constexpr double operator/(Quantity a, Quantity b) { return a.value / b.value; }
};

using Millimetres = Quantity<struct MillimetreUnit>;
using Radians = Quantity<struct RadianUnit>;
using Fraction = Quantity<struct FractionUnit>;  // 0 to 1

constexpr Radians degrees(double d) { return Radians(d * (std::numbers::pi / 180)); }
constexpr double in_degrees(Radians r) { return r.value * (180 / std::numbers::pi); }

}  // namespace fude
