// What a hand does with a brush, for figures and tests: eight seconds each, scaled to the length of the tuft.
#pragma once

#include <span>
#include <string_view>

#include "signal/pose.h"
#include "sim/brush/brush_spec.h"

namespace fude {

inline constexpr double bench_gesture_s = 8;

struct BenchGesture {
  std::string_view name;
  std::string_view meaning;
  // Pose of the handle at `time_s` in [0, 8]; smooth but where the meaning says otherwise.
  Pose<Paper, Handle> (*pose)(const BrushSpec& spec, double time_s);
};

// The first is the plain stroke.
std::span<const BenchGesture> bench_gestures();

}  // namespace fude
