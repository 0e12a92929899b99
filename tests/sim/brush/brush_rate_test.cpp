// One gesture is one stroke, however often it is sampled.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "tests/sim/brush/gesture.h"

namespace fude {
namespace {

// A stroke as the hand draws it: set down at a slant, pressed, drawn along a bend, lifted off.
Gesture bent_stroke() {
  return {1.6, [](double t) {
            const double along = ease((t - 0.3) / 1.0);
            const double x = 30 * along;
            const double y = -12 * along * along;
            const double z = 34 - 11 * ease(t / 0.4) + 3 * ease((t - 0.5) / 0.4) - 2 * ease((t - 0.9) / 0.3) +
                             12 * ease((t - 1.2) / 0.35);
            return leaning(x, y, z, 0.25, -0.8 + 0.2 * along);
          }};
}

TEST(BrushRate, TipAndDepositDoNotDependOnTheSampleRate) {
  Trace at[3];
  const double rates[3] = {100, 250, 1000};
  for (int i = 0; i < 3; ++i) {
    Brush brush(BrushSpec{}, 1);
    brush.load(1, {1, 0, 0, 0.1F});
    at[i] = perform(brush, bent_stroke(), rates[i]);
    EXPECT_EQ(at[i].unconverged, 0);
  }
  const Trace& finest = at[2];
  for (int i = 0; i < 2; ++i) {
    const std::size_t stride = static_cast<std::size_t>(1000 / rates[i]);
    double apart = 0;
    std::size_t where = 0;
    for (std::size_t s = 0; s < at[i].tip.size(); ++s) {
      const double d = (at[i].tip[s] - finest.tip[s * stride]).norm();
      if (d > apart) where = s * stride;
      apart = std::max(apart, d);
    }
    const double film = std::abs(at[i].film_mm2 / finest.film_mm2 - 1);
    const double contact = std::abs(at[i].contact_mm2_s / finest.contact_mm2_s - 1);
    std::printf("  %g Hz against 1000: tip %.3f mm (at %zu ms), film %.2f %% of %.1f mm2, contact %.2f %%\n",
                rates[i], apart, where, 100 * film, finest.film_mm2, 100 * contact);
    EXPECT_LE(apart, 0.2);
    EXPECT_LE(film, 0.02);
    EXPECT_LE(contact, 0.02);
  }
}

}  // namespace
}  // namespace fude
