// Which part of the paper is covered, as bits: four by four samples a cell, on a grid that every
// coverage of one cell size shares, so that sets combine word by word and exactly.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace fude {

inline constexpr int samples_per_side = 4;  // of a cell
inline constexpr int cells_per_word = 16;   // a word is one row of samples in 16 cells
inline constexpr int samples_per_word = samples_per_side * cells_per_word;

// Whole words and whole cell rows around a box.
struct CoverageFrame {
  double cell_mm = 0;
  std::int64_t first_word = 0;  // columns, from x = 0
  std::int64_t first_row = 0;   // cell rows, from y = 0
  int words = 0;
  int rows = 0;  // cell rows
  int columns() const { return words * cells_per_word; }
  double left_mm() const { return static_cast<double>(first_word * cells_per_word) * cell_mm; }
  double bottom_mm() const { return static_cast<double>(first_row) * cell_mm; }
};
CoverageFrame frame_around(const Eigen::Vector2d& low_mm, const Eigen::Vector2d& high_mm, double cell_mm);

// Samples covered in each of the 16 cells of a word, 0 to 16, lowest x first.
using SampleCounts = std::uint8_t[cells_per_word];

class Coverage {
 public:
  const CoverageFrame& frame() const { return frame_; }

  // Empty, over this frame. Keeps its memory.
  void reset(const CoverageFrame& frame);
  // Over another frame of the same grid; what lies outside of it is dropped.
  void move_to(const CoverageFrame& frame);

  // Samples [from, to) of a row of samples, counted from the frame's lower left.
  void add_span(int sample_row, int from, int to);
  void add(const Coverage& other);
  // Adds what is in `other` and not in `except`. All over one frame.
  void add_new(const Coverage& other, const Coverage& except);

  bool any(int row, int word) const {
    return (line(row, 0, word) | line(row, 1, word) | line(row, 2, word) | line(row, 3, word)) != 0;
  }
  bool whole(int row, int word) const {
    return ~(line(row, 0, word) & line(row, 1, word) & line(row, 2, word) & line(row, 3, word)) == 0;
  }
  // A bit for each of the 16 cells that holds a sample, lowest x first.
  std::uint64_t cells(int row, int word) const;
  void count_samples(int row, int word, SampleCounts& counts) const;

 private:
  std::uint64_t line(int row, int sample, int word) const {
    return bits_[static_cast<std::size_t>((row * samples_per_side + sample) * frame_.words + word)];
  }

  CoverageFrame frame_;
  std::vector<std::uint64_t> bits_;
  std::vector<std::uint64_t> moved_;
};

}  // namespace fude
