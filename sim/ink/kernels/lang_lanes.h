// How C++ reads the kernel text (*.k) for as many cells in a row as a vector of the instruction set holds:
// the lanes of a `real`. Every lane computes what lang_cpp.h would, bit for bit. The compiler is not left to
// find the loop: over fifty planes at once it spends more on addresses than on sums (docs/kernels.md).
#pragma once

#include <cstddef>

#include "sim/ink/kernels/words_cpp.h"

#define BITS_OF(x) lane_bits(x)
#define FLOAT_OF(x) lanes_of(x)
#define CHOOSE(when, yes, no) chosen(when, yes, no)

namespace fude {
namespace {

#if defined(__AVX512F__)
constexpr int lanes = 16;
#elif defined(__AVX2__)
constexpr int lanes = 8;
#else
constexpr int lanes = 4;
#endif

typedef float Floats __attribute__((vector_size(lanes * sizeof(float))));
typedef int Bits __attribute__((vector_size(lanes * sizeof(int))));

struct choice {
  Bits set;  // all bits of a lane, or none
};

struct real {
  Floats v;
  real() = default;
  [[gnu::always_inline]] real(Floats value) : v(value) {}
  [[gnu::always_inline]] real(float s) : v(s - Floats{}) {}
};

FUNCTION real operator+(const real& a, const real& b) { return a.v + b.v; }
FUNCTION real operator-(const real& a, const real& b) { return a.v - b.v; }
FUNCTION real operator*(const real& a, const real& b) { return a.v * b.v; }
FUNCTION real operator-(const real& a) { return -a.v; }
FUNCTION choice operator<(const real& a, const real& b) { return {a.v < b.v}; }
FUNCTION choice operator>(const real& a, const real& b) { return {a.v > b.v}; }
FUNCTION choice operator>=(const real& a, const real& b) { return {a.v >= b.v}; }
FUNCTION real chosen(const choice& when, const real& yes, const real& no) { return when.set ? yes.v : no.v; }
FUNCTION Bits lane_bits(const real& x) { return (Bits)x.v; }
FUNCTION real lanes_of(const Bits& x) { return (Floats)x; }

FUNCTION real loaded(const float* from) {
  Floats v;
  __builtin_memcpy(&v, from, sizeof v);
  return v;
}
FUNCTION void stored(float* to, const real& x) { __builtin_memcpy(to, &x.v, sizeof x.v); }

}  // namespace
}  // namespace fude

#include "sim/ink/kernels/vec4_cpp.h"
