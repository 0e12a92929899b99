// How C++ reads the kernel text (*.k) for one cell: the words that differ between it and GLSL, and GLSL's
// vec4. Include it at file scope, then the kernels inside an unnamed namespace of fude, so that every
// translation unit keeps copies of its own.
#pragma once

#include <bit>

#include "sim/ink/kernels/words_cpp.h"

#define BITS_OF(x) std::bit_cast<int>(x)
#define FLOAT_OF(x) std::bit_cast<float>(x)
#define CHOOSE(when, yes, no) ((when) ? (yes) : (no))

namespace fude {
namespace {

using real = float;
using choice = bool;

}  // namespace
}  // namespace fude

#include "sim/ink/kernels/vec4_cpp.h"
