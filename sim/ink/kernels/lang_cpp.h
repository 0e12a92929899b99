// How C++ reads the kernel text (*.k): the words that differ between it and GLSL, and GLSL's vec4.
// Include it at file scope, then the kernels inside an unnamed namespace of fude, so that every
// translation unit (one for each instruction set) keeps copies of its own.
#pragma once

#include <bit>

#define FUNCTION [[maybe_unused]] static inline __attribute__((always_inline))
#define IN(type) const type&
#define OUT(type) type&
#define INOUT(type) type&
#define LOCAL(type) type
#define BITS_OF(x) std::bit_cast<int>(x)
#define FLOAT_OF(x) std::bit_cast<float>(x)

namespace fude {
namespace {

struct vec4 {
  float x, y, z, w;
};

FUNCTION vec4 operator+(const vec4& a, const vec4& b) { return {a.x + b.x, a.y + b.y, a.z + b.z, a.w + b.w}; }
FUNCTION vec4 operator-(const vec4& a, const vec4& b) { return {a.x - b.x, a.y - b.y, a.z - b.z, a.w - b.w}; }
FUNCTION vec4 operator*(const vec4& a, float s) { return {a.x * s, a.y * s, a.z * s, a.w * s}; }

}  // namespace
}  // namespace fude
