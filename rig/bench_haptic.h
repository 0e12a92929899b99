// Whether an arm's loop holds its millisecond while the ink runs, against a thread that does nothing else
// than wake up each millisecond.
#pragma once

#include <cstdint>

#include "drivers/falcon/loop_clock.h"
#include "rig/painting.h"
#include "signal/result.h"

namespace fude {

struct HapticBench {
  falcon::Pace::Counts timer;  // of the bare thread
  falcon::Pace::Counts loop;
  std::int64_t samples = 0;  // that the loop had of the arm
  std::int64_t felt = 0;     // of them with a force
  std::int64_t steps = 0;    // of the ink
  bool precedence = false;   // both came before the other threads
};

enum class HapticTurns : std::uint8_t {
  together,  // the whole time, both: what disturbs one disturbs the other, and they disturb each other
  in_turn,   // half a second each, again and again: neither meets the other
};

// Floods a sheet and draws on it (WetSheet) while a simulated arm that feels a plain sheet is driven, and a
// bare thread keeps the same pace with the same precedence, each for `seconds`. Errors: those of the ink's
// back-end.
Result<HapticBench> bench_haptic(const PaintingSetup& setup, double seconds, HapticTurns turns);

// How much greater the share of late periods is in the loop than in the bare thread.
double late_excess(const HapticBench& bench);

}  // namespace fude
