#include "sim/optics/kubelka_munk.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace fude {
namespace {

// The textbook form with hyperbolic functions, where it neither overflows nor cancels.
LayerOptics textbook(double absorption, double scattering) {
  const double a = 1 + absorption / scattering;
  const double b = std::sqrt(a * a - 1);
  const double depth = b * scattering;
  const double divisor = a * std::sinh(depth) + b * std::cosh(depth);
  const double r = std::sinh(depth) / divisor;
  return {r, r, b / divisor};
}

TEST(KubelkaMunk, AgreesWithTheTextbookForm) {
  for (double absorption : {0.01, 0.2, 1.0, 5.0, 30.0})
    for (double scattering : {0.05, 0.3, 1.0, 8.0}) {
      const LayerOptics ours = layer_optics(absorption, scattering);
      const LayerOptics theirs = textbook(absorption, scattering);
      EXPECT_NEAR(ours.reflectance_above, theirs.reflectance_above, 1e-13);
      EXPECT_NEAR(ours.transmittance, theirs.transmittance, 1e-13);
    }
}

TEST(KubelkaMunk, WithoutAbsorptionNoLightIsLost) {
  for (double scattering : {0.0, 1e-12, 0.1, 1.0, 50.0, 1e6}) {
    const LayerOptics layer = layer_optics(0, scattering);
    EXPECT_NEAR(layer.reflectance_above, scattering / (1 + scattering), 1e-15);
    EXPECT_NEAR(layer.transmittance, 1 / (1 + scattering), 1e-15);
  }
}

TEST(KubelkaMunk, WithoutScatteringLightFadesExponentially) {
  for (double absorption : {0.0, 1e-12, 0.1, 1.0, 50.0}) {
    const LayerOptics layer = layer_optics(absorption, 0);
    EXPECT_EQ(layer.reflectance_above, 0);
    EXPECT_NEAR(layer.transmittance / std::exp(-absorption), 1, 1e-14);
  }
}

TEST(KubelkaMunk, IsSmoothWhereTheSeriesTakesOver) {
  // g = √(K(K + 2S)) is 0.01 at the seam; across it the reflectance moves as its slope says.
  const double scattering = 1;
  const double seam = std::sqrt(1 + 1e-4) - 1;
  const double below = layer_optics(seam * (1 - 1e-9), scattering).reflectance_above;
  const double above = layer_optics(seam * (1 + 1e-9), scattering).reflectance_above;
  EXPECT_NEAR(above, below, 1e-13);
  EXPECT_LT(above, below);
}

TEST(KubelkaMunk, AThickLayerReachesItsOpaqueReflectance) {
  for (double absorption : {1e-3, 0.1, 1.0, 20.0})
    for (double scattering : {1e-3, 0.1, 1.0, 20.0}) {
      const LayerOptics thick = layer_optics(absorption * 1e6, scattering * 1e6);
      EXPECT_NEAR(thick.reflectance_above, opaque_reflectance(absorption, scattering), 1e-14);
      EXPECT_EQ(thick.transmittance, 0);
      const double ratio = absorption / scattering;
      EXPECT_NEAR(opaque_reflectance(absorption, scattering),
                  1 + ratio - std::sqrt(ratio * ratio + 2 * ratio), 1e-11);
    }
  EXPECT_EQ(opaque_reflectance(0, 1), 1);
  EXPECT_EQ(opaque_reflectance(1, 0), 0);
}

TEST(KubelkaMunk, ManyThinLayersMakeOneThickOne) {
  const double absorption = 0.7;
  const double scattering = 1.3;
  constexpr int count = 1000;
  const LayerOptics thin = layer_optics(absorption / count, scattering / count);
  LayerOptics stack;
  for (int i = 0; i < count; ++i) stack = composed(thin, stack);
  const LayerOptics whole = layer_optics(absorption, scattering);
  EXPECT_NEAR(stack.reflectance_above, whole.reflectance_above, 1e-12);
  EXPECT_NEAR(stack.reflectance_below, whole.reflectance_below, 1e-12);
  EXPECT_NEAR(stack.transmittance, whole.transmittance, 1e-12);
}

TEST(KubelkaMunk, ACompositeOfUnlikeLayersHasTwoFacesAndOneTransmittance) {
  const LayerOptics red = layer_optics(0.2, 1.5);
  const LayerOptics black = layer_optics(2.0, 0.1);
  const LayerOptics one = composed(red, black);
  const LayerOptics other = composed(black, red);
  EXPECT_NEAR(one.reflectance_above, other.reflectance_below, 1e-15);
  EXPECT_NEAR(one.reflectance_below, other.reflectance_above, 1e-15);
  EXPECT_NEAR(one.transmittance, other.transmittance, 1e-15);
  EXPECT_GT(one.reflectance_above, other.reflectance_above + 0.1);
}

TEST(KubelkaMunk, AGroundIsALayerThatLetsNothingThrough) {
  const LayerOptics paint = composed(layer_optics(0.2, 0.9), layer_optics(0.6, 0.1));
  const LayerOptics ground{0.85, 0.85, 0};
  EXPECT_NEAR(reflectance_over(paint, 0.85), composed(paint, ground).reflectance_above, 1e-15);
}

TEST(KubelkaMunk, TheInverseFindsWhatMadeTheLayer) {
  for (double absorption : {1e-6, 0.02, 0.2, 0.9})
    for (double scattering : {0.05, 0.3, 0.9}) {
      const LayerOptics layer = layer_optics(absorption, scattering);
      const auto found = coefficients_from_grounds(reflectance_over(layer, 1), layer.reflectance_above);
      ASSERT_TRUE(found) << found.error().message;
      EXPECT_NEAR(found->absorption / absorption, 1, 1e-12 + 1e-15 / absorption);
      EXPECT_NEAR(found->scattering / scattering, 1, 1e-12);
    }
}

TEST(KubelkaMunk, TheInverseNamesWhatIsImpossible) {
  const auto rule = [](double white, double black) {
    const auto found = coefficients_from_grounds(white, black);
    return found ? std::string() : found.error().message;
  };
  EXPECT_NE(rule(0.5, 0).find("over black must be above 0"), std::string::npos);
  EXPECT_NE(rule(1, 0.5).find("over white must be below 1"), std::string::npos);
  EXPECT_NE(rule(0.3, 0.4).find("more over white than over black"), std::string::npos);
  EXPECT_NE(rule(0.3, 0.3).find("more over white than over black"), std::string::npos);
  EXPECT_NE(rule(std::numeric_limits<double>::quiet_NaN(), 0.4), "");
  EXPECT_NE(rule(0.5, std::numeric_limits<double>::quiet_NaN()), "");
  EXPECT_NE(rule(0.5, std::nextafter(0.5, 0.0)).find("nearly opaque"), std::string::npos);
}

}  // namespace
}  // namespace fude
