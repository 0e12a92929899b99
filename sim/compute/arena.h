// Equal blocks of floats in large chunks that are touched when they are made, so that waking a tile in
// mid-stroke meets no page fault.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

namespace fude {

class Arena {
 public:
  // Blocks start on cache lines: block_floats is a multiple of 16.
  Arena(std::size_t block_floats, std::size_t blocks_in_chunk);

  // A block. It holds whatever its last user left, zeros at first; makes a chunk where none is free.
  float* take();
  void give_back(float* block);
  std::size_t bytes() const;

 private:
  struct Release {
    void operator()(float* chunk) const;
  };

  void grow();

  std::size_t block_floats_;
  std::size_t blocks_in_chunk_;
  std::vector<std::unique_ptr<float[], Release>> chunks_;
  std::vector<float*> free_;
};

}  // namespace fude
