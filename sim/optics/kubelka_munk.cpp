#include "sim/optics/kubelka_munk.h"

#include <cmath>

#include "signal/elementary.h"

namespace fude {
namespace {

// (1 − exp(−2g)) / g for g >= 0; near 0 the series, where the difference would cancel.
double absorbed_per_depth(double g, double exponential_of_minus_2g) {
  if (g > 0.01) return (1 - exponential_of_minus_2g) / g;
  return 2 - g * (2 - g * (4.0 / 3 - g * (2.0 / 3 - g * (4.0 / 15 - g * (4.0 / 45 - g * (8.0 / 315))))));
}

}  // namespace

double opaque_reflectance(double absorption, double scattering) {
  // a − b = 1/(a + b), which does not cancel for strong absorption.
  return scattering / (scattering + absorption + std::sqrt(absorption * (absorption + 2 * scattering)));
}

LayerOptics layer_optics(double absorption, double scattering) {
  // With g = bSd = √(K(K + 2S)), e = exp(−2g) and q = (1 − e)/g, the formulas in a, b and Sd become
  // R = S q / D and T = 2 √e / D, D = (K + S) q + 1 + e: nothing is divided by K, S or g.
  const double g = std::sqrt(absorption * (absorption + 2 * scattering));
  const double root = elementary::exponential(-g);
  const double e = root * root;
  const double q = absorbed_per_depth(g, e);
  const double denominator = (absorption + scattering) * q + 1 + e;
  const double reflectance = scattering * q / denominator;
  return {reflectance, reflectance, 2 * root / denominator};
}

LayerOptics composed(const LayerOptics& top, const LayerOptics& bottom) {
  const double echoes = 1 / (1 - bottom.reflectance_above * top.reflectance_below);
  return {
      top.reflectance_above + top.transmittance * top.transmittance * bottom.reflectance_above * echoes,
      bottom.reflectance_below + bottom.transmittance * bottom.transmittance * top.reflectance_below * echoes,
      top.transmittance * bottom.transmittance * echoes};
}

double reflectance_over(const LayerOptics& top, double ground) {
  return top.reflectance_above +
         top.transmittance * top.transmittance * ground / (1 - ground * top.reflectance_below);
}

Result<Coefficients> coefficients_from_grounds(double over_white, double over_black) {
  if (!(over_black > 0))
    return failure(Fault::usage, "reflectance over black must be above 0: give at least 0.01");
  if (!(over_white < 1))
    return failure(Fault::usage, "reflectance over white must be below 1: give at most 0.99");
  if (!(over_black < over_white))
    return failure(Fault::usage,
                   "a layer reflects more over white than over black: raise the first or lower the second");
  if (!(over_white - over_black > 1e-8))
    return failure(
        Fault::usage,
        "the layer is too nearly opaque to tell a white ground from a black one: use a thinner one");
  // a, b and arcoth of Curtis et al. with a − 1 factored out, which keeps the digits of nearly white layers.
  const double a_minus_1 = (1 - over_white) * (1 - over_black) / (2 * over_black);
  const double b = std::sqrt(a_minus_1 * (a_minus_1 + 2));
  const double coth = a_minus_1 * (1 + over_white) / (b * (1 - over_white));
  const double scattering = 0.5 * elementary::logarithm((coth + 1) / (coth - 1)) / b;
  return Coefficients{scattering * a_minus_1, scattering};
}

}  // namespace fude
