#include "sim/compute/gl_buffer.h"

#include <epoxy/gl.h>

#include <stdexcept>

namespace fude {
namespace {

GLintptr signed_size(std::size_t n) { return static_cast<GLintptr>(n); }

tl::unexpected<Error> no_room(std::size_t bytes) {
  return failure(Fault::unsupported, "the graphics card has no room for " +
                                         std::to_string(bytes / 1'000'000) +
                                         " MB more: use --backend cpu, larger cells or a smaller sheet");
}

}  // namespace

Result<GlBuffer> GlBuffer::make(std::size_t bytes) {
  // A lost context may never run out of errors.
  for (int i = 0; i < 16 && glGetError() != GL_NO_ERROR; ++i) {
  }
  GlBuffer buffer;
  buffer.bytes_ = bytes;
  glGenBuffers(1, &buffer.id_);
  glBindBuffer(GL_COPY_WRITE_BUFFER, buffer.id_);
  glBufferData(GL_COPY_WRITE_BUFFER, signed_size(bytes), nullptr, GL_DYNAMIC_COPY);
  glClearBufferData(GL_COPY_WRITE_BUFFER, GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
  if (glGetError() != GL_NO_ERROR) return no_room(bytes);
  return buffer;
}

GlBuffer::~GlBuffer() {
  if (id_ != 0) glDeleteBuffers(1, &id_);
}

void GlBuffer::bind_storage(unsigned index) const { glBindBufferBase(GL_SHADER_STORAGE_BUFFER, index, id_); }

void GlBuffer::bind_uniforms(unsigned index) const { glBindBufferBase(GL_UNIFORM_BUFFER, index, id_); }

void GlBuffer::clear(std::size_t offset, std::size_t count) const {
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glBindBuffer(GL_COPY_WRITE_BUFFER, id_);
  glClearBufferSubData(GL_COPY_WRITE_BUFFER, GL_R32UI, signed_size(offset), signed_size(count),
                       GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
}

void GlBuffer::write(std::size_t offset, std::span<const std::byte> from) const {
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glBindBuffer(GL_COPY_WRITE_BUFFER, id_);
  glBufferSubData(GL_COPY_WRITE_BUFFER, signed_size(offset), signed_size(from.size()), from.data());
}

void GlBuffer::read(std::size_t offset, std::span<std::byte> to) const {
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glBindBuffer(GL_COPY_READ_BUFFER, id_);
  glGetBufferSubData(GL_COPY_READ_BUFFER, signed_size(offset), signed_size(to.size()), to.data());
}

void GlBuffer::copy_to(const GlBuffer& to, std::size_t from_offset, std::size_t to_offset,
                       std::size_t count) const {
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glBindBuffer(GL_COPY_READ_BUFFER, id_);
  glBindBuffer(GL_COPY_WRITE_BUFFER, to.id_);
  glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, signed_size(from_offset),
                      signed_size(to_offset), signed_size(count));
}

Result<GlTexels> GlTexels::make(std::size_t bytes, Kind kind) {
  constexpr std::size_t bytes_a_texel = 16;
  GLint most = 0;
  glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most);
  if (bytes / bytes_a_texel > static_cast<std::size_t>(most)) return no_room(bytes);
  auto buffer = GlBuffer::make(bytes);
  if (!buffer) return tl::unexpected(buffer.error());
  GlTexels texels;
  texels.buffer_ = std::move(*buffer);
  glGenTextures(1, &texels.texture_);
  glBindTexture(GL_TEXTURE_BUFFER, texels.texture_);
  glTexBuffer(GL_TEXTURE_BUFFER, kind == Kind::floats ? GL_RGBA32F : GL_RGBA32I, texels.buffer_.id());
  if (glGetError() != GL_NO_ERROR) return no_room(bytes);
  return texels;
}

GlTexels::~GlTexels() {
  if (texture_ != 0) glDeleteTextures(1, &texture_);
}

void GlTexels::bind_texture(unsigned unit) const {
  glActiveTexture(GL_TEXTURE0 + unit);
  glBindTexture(GL_TEXTURE_BUFFER, texture_);
}

Result<GlReadBack> GlReadBack::begin(const GlBuffer& from, std::size_t offset, std::size_t bytes) {
  auto staging = GlBuffer::make(bytes);
  if (!staging) return tl::unexpected(staging.error());
  GlReadBack back;
  back.staging_ = std::move(*staging);
  from.copy_to(back.staging_, offset, 0, bytes);
  back.fence_ = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
  glFlush();
  return back;
}

GlReadBack::~GlReadBack() {
  if (fence_) glDeleteSync(static_cast<GLsync>(fence_));
}

bool GlReadBack::arrived() const {
  const GLenum state = glClientWaitSync(static_cast<GLsync>(fence_), 0, 0);
  return state == GL_ALREADY_SIGNALED || state == GL_CONDITION_SATISFIED;
}

std::vector<std::byte> GlReadBack::collect() const {
  constexpr GLuint64 patience_ns = 10'000'000'000;
  const GLenum state = glClientWaitSync(static_cast<GLsync>(fence_), GL_SYNC_FLUSH_COMMANDS_BIT, patience_ns);
  if (state != GL_ALREADY_SIGNALED && state != GL_CONDITION_SATISFIED)
    throw std::runtime_error("the graphics card does not answer any more: use --backend cpu");
  std::vector<std::byte> bytes(staging_.bytes());
  staging_.read(0, bytes);
  return bytes;
}

}  // namespace fude
