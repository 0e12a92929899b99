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
  bool operator==(const CoverageFrame&) const = default;
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
  // Adds `amount` to each cell of a raster over the frame, times the share of it that is covered.
  void add_shares(float amount, std::vector<float>& cells) const;

  bool any(int row, int word) const { return columns(row, word) != 0; }
  bool whole(int row, int word) const {
    const std::uint64_t* w = lines(row, word);
    return ~(w[0] & w[1] & w[2] & w[3]) == 0;
  }
  // A bit for each column of samples in which one of a row of cells is covered, lowest x first.
  std::uint64_t columns(int row, int word) const {
    const std::uint64_t* w = lines(row, word);
    return w[0] | w[1] | w[2] | w[3];
  }
  // A bit for each of the 16 cells that holds a sample, lowest x first.
  std::uint64_t cells(int row, int word) const;
  void count_samples(int row, int word, SampleCounts& counts) const;

  // A step from one coverage to the next, `passed` on the way: adds what is new to `fresh` and all to
  // `touched`, and empties `passed`. All over one frame.
  struct Step {
    const Coverage& before;
    const Coverage& after;
  };
  friend void add_step(const Step& step, Coverage& passed, Coverage& fresh, Coverage& touched);

 private:
  // The four rows of samples of 16 cells.
  const std::uint64_t* lines(int row, int word) const {
    return bits_.data() + static_cast<std::ptrdiff_t>(row * frame_.words + word) * samples_per_side;
  }

  CoverageFrame frame_;
  std::vector<std::uint64_t> bits_;  // rows of cells, words of a row, samples of a word
  std::vector<std::uint64_t> moved_;
};

}  // namespace fude
