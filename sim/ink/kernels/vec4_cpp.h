// GLSL's vec4 for C++. Part of lang_cpp.h and lang_lanes.h.
#pragma once

namespace fude {
namespace {

struct vec4 {
  real x, y, z, w;
};

FUNCTION vec4 operator+(const vec4& a, const vec4& b) { return {a.x + b.x, a.y + b.y, a.z + b.z, a.w + b.w}; }
FUNCTION vec4 operator-(const vec4& a, const vec4& b) { return {a.x - b.x, a.y - b.y, a.z - b.z, a.w - b.w}; }
FUNCTION vec4 operator*(const vec4& a, const real& s) { return {a.x * s, a.y * s, a.z * s, a.w * s}; }

}  // namespace
}  // namespace fude
