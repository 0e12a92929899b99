#include "sim/brush/coverage.h"

#include <algorithm>
#include <cmath>

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

void Coverage::reset(const CoverageFrame& frame) {
  frame_ = frame;
  bits_.assign(
      static_cast<std::size_t>(frame.words) * static_cast<std::size_t>(frame.rows) * samples_per_side, 0);
}

void Coverage::move_to(const CoverageFrame& frame) {
  const CoverageFrame old = frame_;
  std::swap(bits_, moved_);
  reset(frame);
  const std::int64_t first_row = std::max(old.first_row, frame.first_row);
  const std::int64_t end_row = std::min(old.first_row + old.rows, frame.first_row + frame.rows);
  const std::int64_t first_word = std::max(old.first_word, frame.first_word);
  const std::int64_t end_word = std::min(old.first_word + old.words, frame.first_word + frame.words);
  if (first_word >= end_word) return;
  for (std::int64_t line = first_row * samples_per_side; line < end_row * samples_per_side; ++line) {
    const auto from = (line - old.first_row * samples_per_side) * old.words - old.first_word;
    const auto to = (line - frame.first_row * samples_per_side) * frame.words - frame.first_word;
    std::copy(moved_.begin() + from + first_word, moved_.begin() + from + end_word,
              bits_.begin() + to + first_word);
  }
}

void Coverage::add_span(int sample_row, int from, int to) {
  if (from >= to) return;
  std::uint64_t* words = bits_.data() + static_cast<std::ptrdiff_t>(sample_row) * frame_.words;
  const int last = to - 1;
  const int a = from / samples_per_word;
  const int b = last / samples_per_word;
  const std::uint64_t head = ~std::uint64_t{0} << (from & 63);
  const std::uint64_t tail = ~std::uint64_t{0} >> (63 - (last & 63));
  if (a == b) {
    words[a] |= head & tail;
    return;
  }
  words[a] |= head;
  for (int w = a + 1; w < b; ++w) words[w] = ~std::uint64_t{0};
  words[b] |= tail;
}

void Coverage::add(const Coverage& other) {
  for (std::size_t i = 0; i < bits_.size(); ++i) bits_[i] |= other.bits_[i];
}

void Coverage::add_new(const Coverage& other, const Coverage& except) {
  for (std::size_t i = 0; i < bits_.size(); ++i) bits_[i] |= other.bits_[i] & ~except.bits_[i];
}

std::uint64_t Coverage::cells(int row, int word) const {
  std::uint64_t w = line(row, 0, word) | line(row, 1, word) | line(row, 2, word) | line(row, 3, word);
  w |= w >> 1;
  w |= w >> 2;
  // The lowest bit of each nibble, drawn together.
  w &= 0x1111111111111111ULL;
  w = (w | w >> 3) & 0x0303030303030303ULL;
  w = (w | w >> 6) & 0x000f000f000f000fULL;
  w = (w | w >> 12) & 0x000000ff000000ffULL;
  return (w | w >> 24) & 0xffff;
}

void Coverage::count_samples(int row, int word, SampleCounts& counts) const {
  // Bits of each nibble are added up side by side, then even and odd nibbles in bytes of their own.
  std::uint64_t even = 0;
  std::uint64_t odd = 0;
  for (int s = 0; s < samples_per_side; ++s) {
    std::uint64_t w = line(row, s, word);
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
