// Which part of the paper is covered, as bits: four by four samples a cell, on a grid that every
// coverage of one cell size shares, so that sets combine word by word and exactly.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace fude {

inline constexpr int samples_per_side = 4;  // of a cell
inline constexpr int cells_per_word = 16;   // a word is one row of samples in 16 cells

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

class Coverage {
 public:
  explicit Coverage(const CoverageFrame& frame);

  const CoverageFrame& frame() const { return frame_; }
  void clear();

  // Adds every sample whose centre lies in the triangle (mm; either orientation; inside the frame).
  void add_triangle(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c);

  void add(const Coverage& other);
  // Adds what is in `other` and not in `except`.
  void add_new(const Coverage& other, const Coverage& except);

  // Samples covered in each of the 16 cells of a word, 0 to 16, lowest x first.
  void count_samples(int row, int word, std::uint8_t (&counts)[cells_per_word]) const;
  bool any(int row, int word) const;

 private:
  std::uint64_t* line(int sample_row) {
    return bits_.data() + static_cast<std::ptrdiff_t>(sample_row) * frame_.words;
  }
  const std::uint64_t* line(int sample_row) const {
    return bits_.data() + static_cast<std::ptrdiff_t>(sample_row) * frame_.words;
  }
  void add_span(int sample_row, double from, double to);

  CoverageFrame frame_;
  std::vector<std::uint64_t> bits_;
};

}  // namespace fude
