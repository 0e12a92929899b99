#include "sim/compute/gl_program.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <vector>

namespace fude {
namespace {

// The name in `#include "name"`, empty for any other line.
std::string_view included(std::string_view line) {
  constexpr std::string_view opening = "#include \"";
  if (!line.starts_with(opening) || !line.ends_with('"')) return {};
  return line.substr(opening.size(), line.size() - opening.size() - 1);
}

class Assembly {
 public:
  explicit Assembly(const TextOf& text_of) : text_of_(text_of) {}

  Result<void> add(std::string_view name) {
    if (std::ranges::find(names_, name) != names_.end()) return {};
    const auto text = text_of_(name);
    if (!text) return failure(Fault::not_found, "no kernel text called " + std::string(name));
    const std::size_t number = names_.size();
    names_.emplace_back(name);
    begin_line(1, number);
    std::istringstream lines{std::string(*text)};
    std::string line;
    for (int at = 1; std::getline(lines, line); ++at) {
      const std::string_view inner = included(line);
      if (inner.empty()) {
        text_ += line + '\n';
        continue;
      }
      if (auto done = add(inner); !done) return done;
      begin_line(at + 1, number);
    }
    return {};
  }

  std::string finish() {
    for (std::size_t i = 0; i < names_.size(); ++i)
      text_ += "// source " + std::to_string(i) + ": " + names_[i] + '\n';
    return std::move(text_);
  }

 private:
  void begin_line(int line, std::size_t source) {
    text_ += "#line " + std::to_string(line) + ' ' + std::to_string(source) + '\n';
  }

  const TextOf& text_of_;
  std::vector<std::string> names_;
  std::string text_;
};

// The compiler's first complaint.
std::string first_line(const std::string& log) { return log.substr(0, log.find('\n')); }

template <class GetParameter, class GetLog>
std::string log_of(unsigned id, GetParameter get_parameter, GetLog get_log) {
  GLint length = 0;
  get_parameter(id, GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(length), '\0');
  get_log(id, length, nullptr, log.data());
  return first_line(log);
}

}  // namespace

Result<std::string> with_includes(std::string_view name, const TextOf& text_of) {
  Assembly assembly(text_of);
  if (auto done = assembly.add(name); !done) return tl::unexpected(done.error());
  return assembly.finish();
}

Result<GlProgram> GlProgram::compile(std::string_view name, std::string_view head, const TextOf& text_of) {
  const auto body = with_includes(name, text_of);
  if (!body) return tl::unexpected(body.error());
  const std::string source = std::string(head) + *body;
  const char* text = source.c_str();
  const GLuint shader = glCreateShader(GL_COMPUTE_SHADER);
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  GLint done = GL_FALSE;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &done);
  if (!done) {
    const std::string log = log_of(shader, glGetShaderiv, glGetShaderInfoLog);
    glDeleteShader(shader);
    return failure(Fault::unsupported,
                   "this OpenGL driver refuses " + std::string(name) + " (" + log + "): use --backend cpu");
  }
  GlProgram program(glCreateProgram());
  glAttachShader(program.id_, shader);
  glLinkProgram(program.id_);
  glDeleteShader(shader);
  glGetProgramiv(program.id_, GL_LINK_STATUS, &done);
  if (!done)
    return failure(Fault::unsupported, "this OpenGL driver cannot link " + std::string(name) + " (" +
                                           log_of(program.id_, glGetProgramiv, glGetProgramInfoLog) +
                                           "): use --backend cpu");
  return program;
}

GlProgram::~GlProgram() {
  if (id_ != 0) glDeleteProgram(id_);
}

void GlProgram::run(std::uint32_t groups_x, std::uint32_t groups_y) const {
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
  glUseProgram(id_);
  glDispatchCompute(groups_x, groups_y, 1);
}

void GlProgram::set(const char* uniform, int value) const {
  const GLint location = glGetUniformLocation(id_, uniform);
  if (location < 0) throw std::invalid_argument(std::string("no uniform called ") + uniform);
  glProgramUniform1i(id_, location, value);
}

}  // namespace fude
