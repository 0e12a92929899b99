// The gestures of docs/calibration.md by which a brush shows what it is made of.
#pragma once

#include <string>
#include <vector>

#include "sim/brush/twin_trial.h"
#include "tests/sim/brush/gesture.h"

namespace fude {

struct NamedHand {
  std::string name;
  std::vector<HandMoment> hand;
};

// For hair of this length; so many moments a second.
inline std::vector<NamedHand> twin_gestures(double length_mm, double rate_hz) {
  const double l = length_mm;
  // Down from above, and up again at a time.
  const auto height = [l](double t, double low, double up_at) {
    return l * (1.1 + (low - 1.1) * ease(t / 0.4) + (1.2 - low) * ease((t - up_at) / 0.2));
  };
  const auto across = [&](double t) {
    return leaning(0, 1.2 * l * ease((t - 0.3) / 0.7), height(t, 0.6, 1), 0.35, 0);
  };
  const auto along = [&](double t) {
    return leaning(1.2 * l * ease((t - 0.2) / 0.8), 0, height(t, 0.58, 1), 0.35, 0);
  };
  const auto pressed = [&](double t) {
    return leaning(1.5 * l * ease((t - 0.1) / 0.9), 0, height(t, 0.5, 1), 0.4, 0);
  };
  const auto corner = [&](double t) {
    return leaning(0.9 * l * ease((t - 0.3) / 0.5), 0.9 * l * ease((t - 0.8) / 0.5), height(t, 0.65, 1.3),
                   0.3, 0);
  };
  const auto touch = [&](double t) { return leaning(0, 0, height(t, 0.66, 0.5), 0.35, 0); };
  // Pressed, lifted off, set beside it at once: bent as it was left.
  const auto again = [&](double t) {
    const double up =
        0.55 * ease((t - 0.9) / 0.15) - 0.25 * ease((t - 1.2) / 0.2) + 0.3 * ease((t - 1.5) / 0.2);
    return leaning(l * (1.2 * ease((t - 0.2) / 0.7) + ease((t - 1) / 0.2)), 0, height(t, 0.55, 9) + l * up,
                   0.3, 0);
  };
  std::vector<NamedHand> hands;
  const auto add = [&](const char* name, double seconds, const auto& pose) {
    NamedHand named{name, {}};
    for (int i = 0; i <= seconds * rate_hz; ++i) named.hand.push_back({i / rate_hz, pose(i / rate_hz), {}});
    hands.push_back(std::move(named));
  };
  add("touch", 0.7, touch);
  add("along", 1.2, along);
  add("pressed", 1.2, pressed);
  add("across", 1.2, across);
  add("corner", 1.5, corner);
  add("again", 1.7, again);
  return hands;
}

}  // namespace fude
