// The words of the kernel text (*.k) that C++ reads alike for one cell (lang_cpp.h) and for several at once
// (lang_lanes.h).
#pragma once

#define FUNCTION [[maybe_unused]] static inline __attribute__((always_inline))
#define IN(type) const type&
#define OUT(type) type&
#define INOUT(type) type&
#define LOCAL(type) type
