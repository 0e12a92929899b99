#include "sim/compute/copy_bandwidth.h"

#include <emmintrin.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <memory>

namespace fude {
namespace {

constexpr std::size_t piece = std::size_t{256} << 10;

struct Free {
  void operator()(std::byte* memory) const { std::free(memory); }
};
using Memory = std::unique_ptr<std::byte[], Free>;

Memory allocate(std::size_t bytes, int fill) {
  Memory memory(static_cast<std::byte*>(std::aligned_alloc(4096, bytes)));
  if (!memory) throw std::bad_alloc();
  std::memset(memory.get(), fill, bytes);
  return memory;
}

void stream_copy(std::byte* to, const std::byte* from, std::size_t bytes) {
  auto* out = reinterpret_cast<__m128i*>(to);
  const auto* in = reinterpret_cast<const __m128i*>(from);
  for (std::size_t i = 0; i < bytes / sizeof(__m128i); ++i) _mm_stream_si128(out + i, _mm_load_si128(in + i));
  _mm_sfence();
}

template <class Copy>
double seconds_of(ThreadPool& pool, std::size_t pieces, const Copy& copy) {
  const auto start = std::chrono::steady_clock::now();
  pool.for_each(pieces, copy);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

double copy_gigabytes_per_second(ThreadPool& pool, std::size_t bytes, int rounds) {
  const std::size_t pieces = std::max<std::size_t>(1, bytes / piece);
  const Memory from = allocate(pieces * piece, 1);
  const Memory to = allocate(pieces * piece, 0);
  double best = 1e30;
  for (int round = 0; round < rounds; ++round) {
    best = std::min(best, seconds_of(pool, pieces, [&](std::size_t i) {
                      std::memcpy(to.get() + i * piece, from.get() + i * piece, piece);
                    }));
    best = std::min(best, seconds_of(pool, pieces, [&](std::size_t i) {
                      stream_copy(to.get() + i * piece, from.get() + i * piece, piece);
                    }));
  }
  return 2e-9 * static_cast<double>(pieces * piece) / best;
}

}  // namespace fude
