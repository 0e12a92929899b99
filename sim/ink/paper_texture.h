// The sheet's textures: a pure function of seed and place, made when a tile wakes, so that a large sheet
// costs nothing. Lengths are millimetres of paper: a finer lattice sees the same fibres.
#pragma once

#include <cstdint>

#include "sim/ink/paper.h"
#include "sim/ink/tile_layout.h"

namespace fude {

// What grows in the paper at one place, each 0 to 1.
struct Texture {
  float grain = 0;  // G: thickness, of fibres and clouds (Chu 3.7.1)
  float pins = 0;   // P: light segments on dark (3.7.3)
  float alum = 0;   // A
};

class PaperTexture {
 public:
  // columns × rows: cells of the sheet. flow: false blocks every cell, so that ink dries where it was laid.
  PaperTexture(const PaperSpec& paper, std::uint64_t seed, double cell_mm, int columns, int rows, bool flow);

  // The textures of the tile::side × tile::side cells from (left, bottom) on, row by row.
  void sample(int left, int bottom, Texture* cells) const;

  // Writes the paper planes of the tile whose lower left cell is (left, bottom); cells off the sheet are
  // closed.
  void fill(int left, int bottom, const PlaneView& view) const;

 private:
  PaperSpec paper_;
  std::uint64_t seed_;
  double cell_mm_;
  int columns_;
  int rows_;
  bool flow_;
};

}  // namespace fude
