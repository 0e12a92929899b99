// Equal blocks of floats in large chunks that are touched when they are made, so that waking a tile in
// mid-stroke meets no page fault. A block may have several parts: the first parts of a chunk's blocks lie
// one after the other, then all the second parts, and so on.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

namespace fude {

class Arena {
 public:
  // Parts start on cache lines: part_floats is a multiple of 16.
  Arena(std::size_t part_floats, std::size_t blocks_in_chunk, std::size_t parts = 1);

  // The first part of a block; the others follow part_floats × blocks_in_chunk floats apart. It holds
  // whatever its last user left, zeros at first; makes a chunk where none is free.
  float* take();
  void give_back(float* block);
  std::size_t bytes() const;

 private:
  struct Release {
    void operator()(float* chunk) const;
  };

  void grow();

  std::size_t part_floats_;
  std::size_t blocks_in_chunk_;
  std::size_t parts_;
  std::vector<std::unique_ptr<float[], Release>> chunks_;
  std::vector<float*> free_;
};

}  // namespace fude
