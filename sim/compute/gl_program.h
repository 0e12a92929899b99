// Compute shaders from text that stands in several files.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "signal/result.h"

namespace fude {

// Finds the text of an included file by the name in its #include line.
using TextOf = std::function<std::optional<std::string_view>(std::string_view name)>;

// GLSL has no #include: replaces each line `#include "name"` by that file's text, with #line directives that
// number the files in the order they come in, and lists them as comments at the end, for the compiler's
// messages. Each file goes in once. Errors: not_found, naming the file.
Result<std::string> with_includes(std::string_view name, const TextOf& text_of);

// A compiled compute shader; made and used with one context current.
class GlProgram {
 public:
  // `head` goes in front of the text: the #version line and definitions.
  // Errors: unsupported, with the compiler's first complaint.
  static Result<GlProgram> compile(std::string_view name, std::string_view head, const TextOf& text_of);

  GlProgram(GlProgram&& other) noexcept : id_(std::exchange(other.id_, 0)) {}
  GlProgram& operator=(GlProgram&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }
  ~GlProgram();

  // Runs it over so many work-groups, after all that earlier runs wrote is there to be read.
  void run(std::uint32_t groups_x, std::uint32_t groups_y = 1) const;

  // Sets an int uniform, which must be in use.
  void set(const char* uniform, int value) const;

 private:
  explicit GlProgram(unsigned id) : id_(id) {}
  unsigned id_;
};

}  // namespace fude
