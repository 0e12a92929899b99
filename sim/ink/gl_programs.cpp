#include "sim/ink/gl_programs.h"

#include "sim/ink/tile_layout.h"

namespace fude {

std::string gl_head() {
  std::string head = "#version 430\n";
  head += "#define SIDE " + std::to_string(tile::side) + "\n";
  head += "#define CELLS " + std::to_string(tile::cells) + "\n";
  head += "#define MARGIN " + std::to_string(wet_margin) + "\n";
  head += "struct LatticeNumbers {\n";
#define NUMBER(name, meaning) head += "  float " #name ";\n";
#include "sim/ink/kernels/lattice_numbers.inl"
#undef NUMBER
  return head + "};\n";
}

Result<GlInkPrograms> GlInkPrograms::compile() {
  const std::string head = gl_head();
  auto step = GlProgram::compile("gl_step.comp", head, kernel_text);
  if (!step) return tl::unexpected(step.error());
  auto tally = GlProgram::compile("gl_tally.comp", head, kernel_text);
  if (!tally) return tl::unexpected(tally.error());
  auto deposit = GlProgram::compile("gl_deposit.comp", head, kernel_text);
  if (!deposit) return tl::unexpected(deposit.error());
  return GlInkPrograms{std::move(*step), std::move(*tally), std::move(*deposit)};
}

}  // namespace fude
