// How long a pen event takes until its deposit can be read by the next ink step, while a wet sheet is
// being stepped in real time.
#pragma once

#include "rig/painting.h"
#include "rig/replay.h"
#include "signal/result.h"

namespace fude {

struct PipelineBench {
  Quantiles latency_us;
  std::int64_t events = 0;
  std::int64_t steps = 0;
  std::int64_t wet_cells = 0;
};

// Floods a sheet of 512 × 512 cells, then draws on it with a pen of 200 reports a second for `seconds`.
// Errors: those of the ink's back-end.
Result<PipelineBench> bench_pipeline(const PaintingSetup& setup, double seconds);

}  // namespace fude
