// The ink's compute programs: the kernel text (*.k), read as GLSL, in its entry points (gl_*.comp).
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include "signal/result.h"
#include "sim/compute/gl_program.h"

namespace fude {

// The text of a kernel or entry point by its file name; it is part of the program.
std::optional<std::string_view> kernel_text(std::string_view name);

// A tile's neighbour is woken while water is still this many cells from it, because word of the water
// reaches the processor some steps late (gl_lattice.h).
inline constexpr int wet_margin = 8;

struct GlInkPrograms {
  GlProgram step;
  GlProgram tally;
  GlProgram deposit;

  // With a context current. Errors: unsupported, when the driver refuses a program.
  static Result<GlInkPrograms> compile();
};

// What stands in front of every program: the version, sizes and the lattice's numbers.
std::string gl_head();

}  // namespace fude
