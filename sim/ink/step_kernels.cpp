#include "sim/ink/tile_step.h"

namespace fude {

extern const StepKernels step_kernels_sse2;
extern const StepKernels step_kernels_avx2;
extern const StepKernels step_kernels_avx512;

const StepKernels& step_kernels(InstructionSet set) {
  switch (set) {
    case InstructionSet::avx512:
      return step_kernels_avx512;
    case InstructionSet::avx2:
      return step_kernels_avx2;
    case InstructionSet::sse2:
      break;
  }
  return step_kernels_sse2;
}

}  // namespace fude
