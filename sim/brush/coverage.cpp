#include "sim/brush/coverage.h"

#include <algorithm>
#include <cmath>

#include "sim/brush/scanline.h"

namespace fude {

using Eigen::Vector2d;

CoverageFrame frame_around(const Vector2d& low, const Vector2d& high, double cell_mm) {
  CoverageFrame f;
  f.cell_mm = cell_mm;
  f.first_word = static_cast<std::int64_t>(std::floor(low.x() / (cells_per_word * cell_mm)));
  f.first_row = static_cast<std::int64_t>(std::floor(low.y() / cell_mm));
  f.words = static_cast<int>(static_cast<std::int64_t>(std::floor(high.x() / (cells_per_word * cell_mm))) -
                             f.first_word) +
            1;
  f.rows = static_cast<int>(static_cast<std::int64_t>(std::floor(high.y() / cell_mm)) - f.first_row) + 1;
  return f;
}

Coverage::Coverage(const CoverageFrame& frame)
    : frame_(frame),
      bits_(static_cast<std::size_t>(frame.words) * static_cast<std::size_t>(frame.rows) * samples_per_side) {
}

void Coverage::clear() { std::fill(bits_.begin(), bits_.end(), 0); }

// Samples whose centres lie in [from, to), in samples from the frame's left edge.
void Coverage::add_span(int sample_row, double from, double to) {
  const int width = frame_.words * 64;
  const int first = first_centre(from, width);
  const int last = first_centre(to, width) - 1;
  if (first > last) return;
  std::uint64_t* words = line(sample_row);
  const int a = first >> 6;
  const int b = last >> 6;
  const std::uint64_t head = ~std::uint64_t{0} << (first & 63);
  const std::uint64_t tail = ~std::uint64_t{0} >> (63 - (last & 63));
  if (a == b) {
    words[a] |= head & tail;
    return;
  }
  words[a] |= head;
  for (int w = a + 1; w < b; ++w) words[w] = ~std::uint64_t{0};
  words[b] |= tail;
}

void Coverage::add_triangle(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  const double scale = samples_per_side / frame_.cell_mm;
  const Vector2d origin(frame_.left_mm(), frame_.bottom_mm());
  scan_triangle((a - origin) * scale, (b - origin) * scale, (c - origin) * scale,
                frame_.rows * samples_per_side,
                [this](int row, double from, double to) { add_span(row, from, to); });
}

void Coverage::add(const Coverage& other) {
  for (std::size_t i = 0; i < bits_.size(); ++i) bits_[i] |= other.bits_[i];
}

void Coverage::add_new(const Coverage& other, const Coverage& except) {
  for (std::size_t i = 0; i < bits_.size(); ++i) bits_[i] |= other.bits_[i] & ~except.bits_[i];
}

bool Coverage::any(int row, int word) const {
  std::uint64_t all = 0;
  for (int s = 0; s < samples_per_side; ++s) all |= line(row * samples_per_side + s)[word];
  return all != 0;
}

void Coverage::count_samples(int row, int word, std::uint8_t (&counts)[cells_per_word]) const {
  // Bits of each nibble are added up side by side, then even and odd nibbles in bytes of their own.
  std::uint64_t even = 0;
  std::uint64_t odd = 0;
  for (int s = 0; s < samples_per_side; ++s) {
    std::uint64_t w = line(row * samples_per_side + s)[word];
    w -= (w >> 1) & 0x5555555555555555ULL;
    w = (w & 0x3333333333333333ULL) + ((w >> 2) & 0x3333333333333333ULL);
    even += w & 0x0f0f0f0f0f0f0f0fULL;
    odd += (w >> 4) & 0x0f0f0f0f0f0f0f0fULL;
  }
  for (int pair = 0; pair < cells_per_word / 2; ++pair) {
    counts[2 * pair] = static_cast<std::uint8_t>(even >> (8 * pair));
    counts[2 * pair + 1] = static_cast<std::uint8_t>(odd >> (8 * pair));
  }
}

}  // namespace fude
