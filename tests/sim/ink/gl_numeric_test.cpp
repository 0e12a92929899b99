// The elementary functions of the kernels give the same bits in GLSL as in C++.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <random>

#include "sim/compute/gl_buffer.h"
#include "sim/compute/gl_context.h"
#include "sim/ink/gl_programs.h"
#include "sim/ink/kernels/lang_cpp.h"

namespace fude {
namespace {

// clang-format off
#include "sim/ink/kernels/numeric.k"
// clang-format on

constexpr std::string_view program_text =
    "#include \"lang_glsl.inc\"\n"
    "#include \"numeric.k\"\n"
    "layout(local_size_x = 64) in;\n"
    "layout(std430, binding = 0) readonly buffer In { float x[]; };\n"
    "layout(std430, binding = 1) writeonly buffer Out { vec4 y[]; };\n"
    "void main() {\n"
    "  uint i = gl_GlobalInvocationID.x;\n"
    "  precise float share = 0.6 * x[i] - x[i] * x[i];\n"
    "  y[i] = vec4(reciprocal(x[i]), decay(least(x[i], 80.0)), smooth_rise(x[i]), share);\n"
    "}\n";

std::optional<std::string_view> text_of(std::string_view name) {
  return name == "numeric_test.comp" ? program_text : kernel_text(name);
}

TEST(GlNumeric, HasTheBitsOfTheProcessor) {
  const auto context = GlContext::open(GlContext::Renderer::any);
  ASSERT_TRUE(context) << context.error().message;
  const auto program = GlProgram::compile("numeric_test.comp", "#version 430\n", text_of);
  ASSERT_TRUE(program) << program.error().message;
  std::mt19937 random(5);
  std::uniform_real_distribution<float> exponent(-60, 60);
  std::uniform_real_distribution<float> small(0, 2);
  std::vector<float> x(65536);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = i % 2 == 0 ? std::exp2(exponent(random)) : small(random);
  const auto in = GlBuffer::make(x.size() * sizeof(float));
  const auto out = GlBuffer::make(x.size() * 4 * sizeof(float));
  ASSERT_TRUE(in && out);
  in->write(0, bytes_of(x));
  in->bind_storage(0);
  out->bind_storage(1);
  program->run(static_cast<std::uint32_t>(x.size() / 64));
  std::vector<float> y(4 * x.size());
  out->read(0, std::as_writable_bytes(std::span(y)));
  for (std::size_t i = 0; i < x.size(); ++i) {
    const float want[] = {reciprocal(x[i]), decay(least(x[i], 80.0F)), smooth_rise(x[i]),
                          0.6F * x[i] - x[i] * x[i]};
    for (std::size_t f = 0; f < 4; ++f)
      ASSERT_EQ(std::bit_cast<std::uint32_t>(y[4 * i + f]), std::bit_cast<std::uint32_t>(want[f]))
          << "function " << f << " at " << x[i] << ": " << y[4 * i + f] << " for " << want[f];
  }
}

}  // namespace
}  // namespace fude
