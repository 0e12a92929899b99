#include <cmath>

#include "sim/ink/cpu_ink.h"
#ifdef FUDE_OPENGL
#include "sim/ink/gl_ink.h"
#endif
#include "sim/ink/ink.h"

namespace fude {
namespace {

// Tiles are counted in 32 bits, and a table of them is kept: 65 536 cells a side is 6.5 m at 0.1 mm.
constexpr double most_cells = 65536;

bool fits(double mm, double cell_mm) { return std::isfinite(mm) && mm > 0 && mm / cell_mm <= most_cells; }

}  // namespace

InkBackend best_ink_backend() {
#ifdef FUDE_OPENGL
  if (graphics_card_exists()) return InkBackend::gl;
#endif
  return InkBackend::cpu;
}

Result<std::unique_ptr<Ink>> open_ink(const InkSetup& setup) {
  if (!(setup.cell_mm >= 0.02 && setup.cell_mm <= 1))
    return failure(Fault::usage, "the cells of the lattice must be 0.02 to 1 mm");
  if (!fits(setup.width_mm, setup.cell_mm) || !fits(setup.height_mm, setup.cell_mm))
    return failure(Fault::usage,
                   "the sheet must have 1 to 65536 cells a side; make it smaller or the cells larger");
  if (setup.threads < 1 || setup.threads > 1024) return failure(Fault::usage, "threads must be 1 to 1024");
  if (setup.backend == InkBackend::gl) {
#ifdef FUDE_OPENGL
    return open_gl_ink(setup);
#else
    return failure(Fault::unsupported, "this build has no OpenGL ink: use --backend cpu");
#endif
  }
  const auto set = choose_instruction_set(setup.instruction_set);
  if (!set) return tl::unexpected(set.error());
  return std::make_unique<CpuInk>(setup, *set);
}

}  // namespace fude
