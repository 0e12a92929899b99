#include <epoxy/egl.h>
#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <thread>

#include "sim/compute/gl_buffer.h"
#include "sim/compute/gl_context.h"
#include "sim/compute/gl_program.h"

namespace fude {
namespace {

const std::map<std::string, std::string, std::less<>> texts = {
    {"double.comp",
     "layout(local_size_x = 64) in;\n"
     "layout(std430, binding = 0) buffer Values { float value[]; };\n"
     "uniform int count;\n"
     "#include \"twice.k\"\n"
     "#include \"twice.k\"\n"
     "void main() {\n"
     "  uint i = gl_GlobalInvocationID.x;\n"
     "  if (i < uint(count)) value[i] = twice(value[i]);\n"
     "}\n"},
    {"twice.k", "float twice(float x) { return 2.0 * x; }\n"},
    {"wrong.comp", "#include \"twice.k\"\nvoid main() { nonsense(); }\n"},
    {"lost.comp", "#include \"nowhere.k\"\n"},
};

std::optional<std::string_view> text_of(std::string_view name) {
  const auto found = texts.find(name);
  if (found == texts.end()) return std::nullopt;
  return found->second;
}

constexpr std::string_view head = "#version 430\n";

TEST(GlContext, KnowsASoftwareRendererByItsName) {
  EXPECT_TRUE(is_software_renderer("llvmpipe (LLVM 15.0.6, 256 bits)"));
  EXPECT_TRUE(is_software_renderer("softpipe"));
  EXPECT_TRUE(is_software_renderer("ANGLE (Google, Vulkan 1.3.0 (SwiftShader Device), SwiftShader driver)"));
  EXPECT_FALSE(is_software_renderer("AMD Radeon RX 6600 (navi23, LLVM 15.0.6, DRM 3.49)"));
  EXPECT_FALSE(is_software_renderer("Mesa Intel(R) UHD Graphics 620 (KBL GT2)"));
  EXPECT_FALSE(is_software_renderer("NVIDIA GeForce RTX 3060/PCIe/SSE2"));
}

TEST(GlContext, OnHardwareOnlyNeverTakesASoftwareRenderer) {
  const auto context = GlContext::open(GlContext::Renderer::hardware_only);
  if (context)
    EXPECT_FALSE(is_software_renderer(context->renderer()));
  else
    EXPECT_NE(context.error().message.find("use --backend cpu"), std::string::npos)
        << context.error().message;
}

TEST(GlContext, MovesBetweenThreads) {
  auto context = GlContext::open(GlContext::Renderer::any);
  ASSERT_TRUE(context) << context.error().message;
  EXPECT_NE(eglGetCurrentContext(), EGL_NO_CONTEXT);
  context->release();
  EXPECT_EQ(eglGetCurrentContext(), EGL_NO_CONTEXT);
  bool made = false;
  std::thread([&] {
    context->make_current();
    made = GlBuffer::make(64).has_value();
    context->release();
  }).join();
  EXPECT_TRUE(made);
}

TEST(KernelText, IncludesEachFileOnceAndNumbersTheLines) {
  EXPECT_EQ(*with_includes("wrong.comp", text_of),
            "#line 1 0\n#line 1 1\nfloat twice(float x) { return 2.0 * x; }\n#line 2 0\nvoid main() { "
            "nonsense(); }\n"
            "// source 0: wrong.comp\n// source 1: twice.k\n");
  const auto lost = with_includes("lost.comp", text_of);
  ASSERT_FALSE(lost);
  EXPECT_NE(lost.error().message.find("nowhere.k"), std::string::npos);
}

TEST(GlProgram, RunsOverABuffer) {
  const auto context = GlContext::open(GlContext::Renderer::any);
  ASSERT_TRUE(context) << context.error().message;
  const auto program = GlProgram::compile("double.comp", head, text_of);
  ASSERT_TRUE(program) << program.error().message;
  std::vector<float> values(1000);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i);
  const auto buffer = GlBuffer::make(values.size() * sizeof(float));
  ASSERT_TRUE(buffer);
  buffer->write(0, bytes_of(values));
  buffer->bind_storage(0);
  program->set("count", 900);
  EXPECT_THROW(program->set("countless", 1), std::invalid_argument);
  program->run(16);
  program->run(16);

  // Taken now, though the buffer changes before it is collected.
  const auto back = GlReadBack::begin(*buffer, 100 * sizeof(float), 850 * sizeof(float));
  ASSERT_TRUE(back);
  program->run(16);
  std::vector<float> seen(850);
  const std::vector<std::byte> bytes = back->collect();
  EXPECT_TRUE(back->arrived());
  std::memcpy(seen.data(), bytes.data(), bytes.size());
  for (std::size_t i = 0; i < seen.size(); ++i)
    ASSERT_EQ(seen[i], static_cast<float>(i + 100) * (i + 100 < 900 ? 4.0F : 1.0F));

  std::vector<float> last(1);
  buffer->read(899 * sizeof(float), std::as_writable_bytes(std::span(last)));
  EXPECT_EQ(last[0], 899 * 8.0F);
}

TEST(GlProgram, SaysWhatTheDriverRefuses) {
  const auto context = GlContext::open(GlContext::Renderer::any);
  ASSERT_TRUE(context) << context.error().message;
  const auto wrong = GlProgram::compile("wrong.comp", head, text_of);
  ASSERT_FALSE(wrong);
  EXPECT_NE(wrong.error().message.find("wrong.comp"), std::string::npos);
  EXPECT_NE(wrong.error().message.find("nonsense"), std::string::npos) << wrong.error().message;
  EXPECT_EQ(wrong.error().message.find('\n'), std::string::npos);
}

TEST(GlBuffer, BeginsWithZerosAndCopies) {
  const auto context = GlContext::open(GlContext::Renderer::any);
  ASSERT_TRUE(context) << context.error().message;
  const auto from = GlBuffer::make(16);
  const auto to = GlBuffer::make(16);
  ASSERT_TRUE(from && to);
  from->write(0, bytes_of(std::vector<std::uint32_t>{1, 2, 3, 4}));
  from->copy_to(*to, 4, 8, 8);
  std::vector<std::uint32_t> seen(4, 9);
  to->read(0, std::as_writable_bytes(std::span(seen)));
  EXPECT_EQ(seen, (std::vector<std::uint32_t>{0, 0, 2, 3}));
}

TEST(GlBuffer, SaysWhenTheCardIsFull) {
  const auto context = GlContext::open(GlContext::Renderer::any);
  ASSERT_TRUE(context) << context.error().message;
  const auto huge = GlBuffer::make(std::size_t{1} << 50);
  ASSERT_FALSE(huge);
  EXPECT_NE(huge.error().message.find("no room"), std::string::npos);
}

}  // namespace
}  // namespace fude
