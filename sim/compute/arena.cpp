#include "sim/compute/arena.h"

#include <sys/mman.h>

#include <cstdlib>
#include <cstring>
#include <new>
#include <stdexcept>

namespace fude {
namespace {

constexpr std::size_t huge_page = std::size_t{2} << 20;

std::size_t chunk_bytes(std::size_t floats) {
  return (floats * sizeof(float) + huge_page - 1) / huge_page * huge_page;
}

}  // namespace

void Arena::Release::operator()(float* chunk) const { std::free(chunk); }

Arena::Arena(std::size_t block_floats, std::size_t blocks_in_chunk)
    : block_floats_(block_floats), blocks_in_chunk_(blocks_in_chunk) {
  if (block_floats % 16 != 0 || blocks_in_chunk == 0)
    throw std::invalid_argument("arena blocks of whole cache lines");
}

void Arena::grow() {
  const std::size_t bytes = chunk_bytes(block_floats_ * blocks_in_chunk_);
  void* memory = std::aligned_alloc(huge_page, bytes);
  if (memory == nullptr) throw std::bad_alloc();
  ::madvise(memory, bytes, MADV_HUGEPAGE);  // a wish: tiles spread over many small pages miss the TLB
  std::memset(memory, 0, bytes);
  chunks_.emplace_back(static_cast<float*>(memory));
  // The last block first: blocks are handed out in the order of their addresses.
  for (std::size_t i = blocks_in_chunk_; i-- > 0;) free_.push_back(chunks_.back().get() + i * block_floats_);
}

float* Arena::take() {
  if (free_.empty()) grow();
  float* block = free_.back();
  free_.pop_back();
  return block;
}

void Arena::give_back(float* block) { free_.push_back(block); }

std::size_t Arena::bytes() const {
  return chunks_.size() * chunk_bytes(block_floats_ * blocks_in_chunk_);
}

}  // namespace fude
