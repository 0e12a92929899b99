// Storage buffers of compute shaders, and reading them back without waiting. For the thread whose OpenGL
// context is current.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "signal/result.h"

namespace fude {

// Untyped memory on the card. Offsets and sizes are bytes.
class GlBuffer {
 public:
  GlBuffer() = default;
  // Zeros. Errors: unsupported, when the card has no room.
  static Result<GlBuffer> make(std::size_t bytes);

  GlBuffer(GlBuffer&& other) noexcept { swap(other); }
  GlBuffer& operator=(GlBuffer&& other) noexcept {
    swap(other);
    return *this;
  }
  ~GlBuffer();

  std::size_t bytes() const { return bytes_; }
  unsigned id() const { return id_; }

  // Makes it the shader's `layout(binding = index) buffer`, or uniform block.
  void bind_storage(unsigned index) const;
  void bind_uniforms(unsigned index) const;

  void clear(std::size_t offset, std::size_t count) const;
  void write(std::size_t offset, std::span<const std::byte> from) const;
  // Waits for the card.
  void read(std::size_t offset, std::span<std::byte> to) const;
  void copy_to(const GlBuffer& to, std::size_t from_offset, std::size_t to_offset, std::size_t count) const;

 private:
  void swap(GlBuffer& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(bytes_, other.bytes_);
  }

  unsigned id_ = 0;
  std::size_t bytes_ = 0;
};

// A buffer that shaders also read as a texture of vec4 or ivec4.
class GlTexels {
 public:
  enum class Kind { floats, ints };

  GlTexels() = default;
  // Zeros. Errors: unsupported, when the card has no room or textures of that size.
  static Result<GlTexels> make(std::size_t bytes, Kind kind = Kind::floats);

  GlTexels(GlTexels&& other) noexcept { swap(other); }
  GlTexels& operator=(GlTexels&& other) noexcept {
    swap(other);
    return *this;
  }
  ~GlTexels();

  const GlBuffer& buffer() const { return buffer_; }
  // Makes it the shader's `layout(binding = unit) uniform samplerBuffer`, or isamplerBuffer.
  void bind_texture(unsigned unit) const;

 private:
  void swap(GlTexels& other) noexcept {
    std::swap(buffer_, other.buffer_);
    std::swap(texture_, other.texture_);
  }

  GlBuffer buffer_;
  unsigned texture_ = 0;
};

template <class T>
std::span<const std::byte> bytes_of(const std::vector<T>& values) {
  return std::as_bytes(std::span(values));
}

// A copy of part of a buffer on its way here. It is taken after all that was asked of the card before it.
class GlReadBack {
 public:
  GlReadBack() = default;
  // Errors: unsupported, when the card has no room.
  static Result<GlReadBack> begin(const GlBuffer& from, std::size_t offset, std::size_t bytes);

  GlReadBack(GlReadBack&& other) noexcept { swap(other); }
  GlReadBack& operator=(GlReadBack&& other) noexcept {
    swap(other);
    return *this;
  }
  ~GlReadBack();

  // Whether the bytes are here: asks, never waits.
  bool arrived() const;
  // The bytes; waits for them where they are still on their way. Throws std::runtime_error where the card is
  // lost, or takes ten seconds.
  std::vector<std::byte> collect() const;

 private:
  void swap(GlReadBack& other) noexcept {
    std::swap(staging_, other.staging_);
    std::swap(fence_, other.fence_);
  }

  GlBuffer staging_;
  void* fence_ = nullptr;  // GLsync
};

}  // namespace fude
