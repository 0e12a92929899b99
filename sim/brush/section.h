// A cross-section of the tuft: two half-ellipses along the lateral line with one minor radius, and
// how deep it hangs (Chu 2.4.2, 2.5.3). Lengths in mm.
#pragma once

#include "signal/elementary.h"

namespace fude {

struct Section {
  double major_a;  // on the side the lateral line points to
  double major_b;
  double minor;
};

// The section of rest radius r whose lateral nodes have moved out by s_a and s_b: at rest a lateral
// node stands at r − r_lat, so that c = r²/(½(a + b) + r_lat) = r²/(r + ½(s_a + s_b)).
inline Section section_of(double r, double s_a, double s_b) {
  return {r + s_a, r + s_b, r * r / (r + 0.5 * (s_a + s_b))};
}

// How far the section's ellipsoid (turned about its lateral axis) reaches below its centre, and the
// derivatives. l_z is the vertical component of the unit lateral line; the low side's radius counts,
// which stays smooth at l_z = 0.
struct Reach {
  double depth;
  double by_lateral_z;
  double by_major_a;
  double by_major_b;
  double by_minor;
};

inline Reach reach_below(const Section& s, double l_z) {
  const bool a_is_low = l_z < 0;
  const double major = a_is_low ? s.major_a : s.major_b;
  const double level = 1 - l_z * l_z;
  const double depth = elementary::square_root(major * major * l_z * l_z + s.minor * s.minor * level);
  const double by_major = major * l_z * l_z / depth;
  return {depth, (major * major - s.minor * s.minor) * l_z / depth, a_is_low ? by_major : 0,
          a_is_low ? 0 : by_major, s.minor * level / depth};
}

}  // namespace fude
