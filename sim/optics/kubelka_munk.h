// How light fares in a layer of paint (Kubelka and Munk 1931; Kubelka 1948, 1954). One wavelength
// band; every number is dimensionless: reflectances and transmittances 0 to 1, and absorption K·d and
// scattering S·d of the whole layer, at least 0 and finite.
#pragma once

#include "signal/result.h"

namespace fude {

// A layer seen from both sides. One that is uniform through its depth looks the same from either.
struct LayerOptics {
  double reflectance_above = 0;
  double reflectance_below = 0;
  double transmittance = 1;
};

// What a layer too thick to see through reflects (R∞): 1 for no absorption, 0 for no scattering; the
// two must not both be 0.
double opaque_reflectance(double absorption, double scattering);

// A uniform layer. No overflow for any thickness, and the limits K → 0 and S → 0 are met smoothly.
LayerOptics layer_optics(double absorption, double scattering);

// `top` lying on `bottom` (Kubelka 1954).
LayerOptics composed(const LayerOptics& top, const LayerOptics& bottom);

// What is seen of a layer on a ground that lets nothing through and reflects `ground`.
double reflectance_over(const LayerOptics& top, double ground);

struct Coefficients {
  double absorption = 0;
  double scattering = 0;
};

// The K and S of a unit layer that reflects `over_white` on a white ground and `over_black` on a black
// one (Curtis et al. 1997). Loses digits as the layer grows opaque: 1e-12 relative while the two and 1
// are 0.01 apart, 3e-3 when they nearly meet.
// Errors: usage, naming the rule, unless 0 < over_black < over_white < 1 and the two are 1e-8 apart.
Result<Coefficients> coefficients_from_grounds(double over_white, double over_black);

}  // namespace fude
