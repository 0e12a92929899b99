// A brush that comes down or lifts, as a pulse in time; and the line that takes one clock to another.
#pragma once

#include <cmath>

namespace fude {

// Seen at t_s and not yet early_s before: it happened at any moment between, the one as likely as the other.
struct Touch {
  double t_s = 0;
  double early_s = 0;
  bool down = true;  // false: it lifts

  double middle_s() const { return t_s - early_s / 2; }
  double variance_s2() const { return early_s * early_s / 12; }
};

// What is added to the times of one stream to bring them to another's: offset_s at reference_s, and `drift`
// seconds more in each second after it.
struct DelayLine {
  double offset_s = 0;
  double drift = 0;
  double reference_s = 0;

  double at(double t_s) const { return offset_s + drift * (t_s - reference_s); }
};

// 97.5 in 100 of Student's t lie below (Abramowitz and Stegun 26.7.5); `freedom` at least 1.
inline double student_975(double freedom) {
  constexpr double z = 1.959963985;
  const double z3 = z * z * z, z5 = z3 * z * z;
  return z + (z3 + z) / (4 * freedom) + (5 * z5 + 16 * z3 + 3 * z) / (96 * freedom * freedom) +
         (3 * z5 * z * z + 19 * z5 + 17 * z3 - 15 * z) / (384 * freedom * freedom * freedom);
}

}  // namespace fude
