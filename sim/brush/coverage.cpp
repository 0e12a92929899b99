#include "sim/brush/coverage.h"

#include <algorithm>
#include <array>
#include <bit>
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
  if (old == frame) return;
  std::swap(bits_, moved_);
  reset(frame);
  const std::int64_t first_row = std::max(old.first_row, frame.first_row);
  const std::int64_t end_row = std::min(old.first_row + old.rows, frame.first_row + frame.rows);
  const std::int64_t first_word = std::max(old.first_word, frame.first_word);
  const std::int64_t end_word = std::min(old.first_word + old.words, frame.first_word + frame.words);
  if (first_word >= end_word) return;
  for (std::int64_t row = first_row; row < end_row; ++row) {
    const auto from = (row - old.first_row) * old.words - old.first_word;
    const auto to = (row - frame.first_row) * frame.words - frame.first_word;
    std::copy(moved_.begin() + samples_per_side * (from + first_word),
              moved_.begin() + samples_per_side * (from + end_word),
              bits_.begin() + samples_per_side * (to + first_word));
  }
}

void Coverage::add_span(int sample_row, int from, int to) {
  if (from >= to) return;
  std::uint64_t* words =
      bits_.data() +
      static_cast<std::ptrdiff_t>(sample_row / samples_per_side * frame_.words) * samples_per_side +
      sample_row % samples_per_side;
  const int last = to - 1;
  const int a = from / samples_per_word;
  const int b = last / samples_per_word;
  const std::uint64_t head = ~std::uint64_t{0} << (from & 63);
  const std::uint64_t tail = ~std::uint64_t{0} >> (63 - (last & 63));
  if (a == b) {
    words[a * samples_per_side] |= head & tail;
    return;
  }
  words[a * samples_per_side] |= head;
  for (int w = a + 1; w < b; ++w) words[w * samples_per_side] = ~std::uint64_t{0};
  words[b * samples_per_side] |= tail;
}

void Coverage::add(const Coverage& other) {
  const std::uint64_t* from = other.bits_.data();
  for (std::uint64_t& word : bits_) word |= *from++;
}

void Coverage::add_new(const Coverage& other, const Coverage& except) {
  const std::uint64_t* from = other.bits_.data();
  const std::uint64_t* without = except.bits_.data();
  for (std::uint64_t& word : bits_) word |= *from++ & ~*without++;
}

void add_step(const Coverage::Step& step, Coverage& passed, Coverage& fresh, Coverage& touched) {
  const std::size_t words = passed.bits_.size();
  const std::uint64_t* before = step.before.bits_.data();
  const std::uint64_t* after = step.after.bits_.data();
  for (std::size_t i = 0; i < words; ++i) {
    const std::uint64_t covered = passed.bits_[i] | after[i];
    fresh.bits_[i] |= covered & ~before[i];
    touched.bits_[i] |= covered | before[i];
    passed.bits_[i] = 0;
  }
}

void Coverage::add_shares(float amount, std::vector<float>& cells) const {
  constexpr float per_sample = 1.0F / (samples_per_side * samples_per_side);
  SampleCounts counts;
  float* cell = cells.data();
  for (int row = 0; row < frame_.rows; ++row)
    for (int word = 0; word < frame_.words; ++word, cell += cells_per_word) {
      if (!any(row, word)) continue;
      if (whole(row, word)) {
        for (int c = 0; c < cells_per_word; ++c) cell[c] += amount;
        continue;
      }
      count_samples(row, word, counts);
      for (int c = 0; c < cells_per_word; ++c) cell[c] += amount * per_sample * static_cast<float>(counts[c]);
    }
}

std::uint64_t Coverage::cells(int row, int word) const {
  std::uint64_t w = columns(row, word);
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
  // Sums of the bits of each nibble; nibbles of even and odd cells added up apart.
  const std::uint64_t* l = lines(row, word);
  std::uint64_t even = 0;
  std::uint64_t odd = 0;
  for (int s = 0; s < samples_per_side; ++s) {
    std::uint64_t w = l[s];
    w -= (w >> 1) & 0x5555555555555555ULL;
    w = (w & 0x3333333333333333ULL) + ((w >> 2) & 0x3333333333333333ULL);
    even += w & 0x0f0f0f0f0f0f0f0fULL;
    odd += (w >> 4) & 0x0f0f0f0f0f0f0f0fULL;
  }
  static_assert(std::endian::native == std::endian::little);
  using Bytes = std::array<std::uint8_t, cells_per_word / 2>;
  const auto evens = std::bit_cast<Bytes>(even);
  const auto odds = std::bit_cast<Bytes>(odd);
  for (std::size_t pair = 0; pair < evens.size(); ++pair) {
    counts[2 * pair] = evens[pair];
    counts[2 * pair + 1] = odds[pair];
  }
}

}  // namespace fude
