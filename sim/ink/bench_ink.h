// How fast this machine steps the ink, against how fast it copies memory.
#pragma once

#include <optional>

#include "signal/result.h"
#include "sim/compute/instruction_set.h"
#include "sim/ink/ink.h"
#include "sim/ink/lattice.h"

namespace fude {

struct InkBenchSetup {
  int side_cells = 512;  // of a square sheet
  double wet = 1;        // share of it that is wet, in upright bars
  int steps = 200;
  Stage stage = Stage::full;
  InkBackend backend = InkBackend::cpu;
  int threads = 1;
  std::optional<InstructionSet> instruction_set;
  bool dense = false;
};

struct InkBenchResult {
  InstructionSet instruction_set{};
  int threads = 0;
  std::size_t cells = 0;
  std::size_t wet_cells = 0;
  std::size_t active_cells = 0;  // of the tiles that were stepped
  double median_ms = 0;          // a step
  double p99_ms = 0;
  double mlups = 0;      // millions of wet cells a second, at the median
  double copy_gb_s = 0;  // the best of memcpy and streaming stores, same threads, arrays of the same size
  double bandwidth_fraction = 0;  // bytes a wet cell (72 for water, 144 for full) times mlups, of copy_gb_s
};

// The OpenGL back-end steps all of the ink on tiles; each of its steps is waited for.
// Fault::usage where a number is out of range; Fault::unsupported for another stage or dense on OpenGL, and
// where the back-end or the instruction set is missing here.
Result<InkBenchResult> bench_ink(const InkBenchSetup& setup);

}  // namespace fude
