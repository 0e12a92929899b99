#include "sim/brush/stamp.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "sim/brush/loading.h"
#include "sim/brush/scanline.h"

namespace fude {

using Eigen::Vector2d;

Stamp::Stamp(const Coverage& touched, const HairTexture& texture, const std::vector<InkLoad>& loads,
             FootprintMap& map)
    : frame_(touched.frame()), texture_(texture), loads_(loads), map_(map) {
  map.patch.assign(map.fresh.size(), 0);
  for (const InkLoad& load : loads)
    streaky_ = streaky_ || static_cast<double>(load.wetness) < texture.streak_wetness();
  if (streaky_) inked_.assign(map.fresh.size(), 1);
  words_ = static_cast<std::size_t>(frame_.columns() + 63) / 64;
  waiting_.assign(words_ * static_cast<std::size_t>(map.rows), 0);
  named_.assign(waiting_.size(), 0);
  constexpr int in_word = 64 / cells_per_word;
  for (int row = 0; row < frame_.rows; ++row)
    for (int word = 0; word < frame_.words; ++word)
      waiting_[static_cast<std::size_t>(row) * words_ + static_cast<std::size_t>(word / in_word)] |=
          touched.cells(row, word) << (word % in_word * cells_per_word);
}

// Calls take(first, end) for each stretch of cells that wait in [first, end); they wait no longer.
template <class Take>
void Stamp::take_waiting(int row, int first, int end, Take take) {
  for (int word = first / 64; word * 64 < end; ++word) {
    const std::size_t i = static_cast<std::size_t>(row) * words_ + static_cast<std::size_t>(word);
    std::uint64_t bits = waiting_[i] & ~std::uint64_t{0} << std::max(first - word * 64, 0);
    if (end - word * 64 < 64) bits &= ~(~std::uint64_t{0} << (end - word * 64));
    waiting_[i] &= ~bits;
    named_[i] |= bits;
    while (bits != 0) {
      const int from = std::countr_zero(bits);
      const int length = std::countr_one(bits >> from);
      take(word * 64 + from, word * 64 + from + length);
      if (from + length == 64) break;
      bits &= ~std::uint64_t{0} << (from + length);
    }
  }
}

Stamp::Corner Stamp::corner(const ContactRing& ring, std::size_t j) const {
  return {(ring.point[j] - Vector2d(frame_.left_mm(), frame_.bottom_mm())) / frame_.cell_mm,
          {ring.along, ring.around[j]}};
}

void Stamp::add(const Contact& contact) {
  for (std::size_t r = 0; r < contact.run_ends.size(); ++r) {
    const auto run = contact.run(r);
    for (std::size_t i = 1; i < run.size(); ++i)
      for (std::size_t j = 1; j < ring_points; ++j) {
        const Corner a = corner(run[i - 1], j - 1);
        const Corner c = corner(run[i], j);
        add_triangle(a, corner(run[i - 1], j), c);
        add_triangle(a, c, corner(run[i], j - 1));
      }
  }
}

// The place on the tuft goes over linearly within a triangle.
void Stamp::add_triangle(const Corner& a, const Corner& b, const Corner& c) {
  const Vector2d u = b.cell - a.cell;
  const Vector2d v = c.cell - a.cell;
  const double area = u.x() * v.y() - u.y() * v.x();
  if (std::abs(area) < 1e-12) return;
  const Vector2d by_u = (b.on_tuft - a.on_tuft) / area;
  const Vector2d by_v = (c.on_tuft - a.on_tuft) / area;
  const Vector2d by_x = v.y() * by_u - u.y() * by_v;
  const Vector2d by_y = u.x() * by_v - v.x() * by_u;
  scan_triangle(a.cell, b.cell, c.cell, map_.rows, [&](int row, double from, double to) {
    const int first = first_centre(from, map_.columns);
    const int end = first_centre(to, map_.columns);
    if (first >= end) return;
    const Vector2d start = a.on_tuft + (row + 0.5 - a.cell.y()) * by_y - a.cell.x() * by_x;
    const auto patch = [&](int column) {
      const Vector2d place = start + (column + 0.5) * by_x;
      return static_cast<std::uint16_t>(patch_at(place[0], place[1]));
    };
    std::uint16_t* patches = map_.patch.data() + at(row, 0);
    take_waiting(row, first, end, [&](int from_column, int end_column) {
      const std::uint16_t head = patch(from_column);
      if (head == patch(end_column - 1))
        std::fill(patches + from_column, patches + end_column, head);
      else
        for (int column = from_column; column < end_column; ++column) patches[column] = patch(column);
      if (!streaky_) return;
      for (int column = from_column; column < end_column; ++column) {
        const Vector2d place = start + (column + 0.5) * by_x;
        const double wetness = static_cast<double>(loads_[patches[column]].wetness);
        inked_[at(row, column)] = static_cast<float>(texture_.inked(place[0], place[1], wetness));
      }
    });
  });
}

std::size_t Stamp::nearest(int row, int column) const {
  const auto named = [&](int y, int x) {
    return (named_[static_cast<std::size_t>(y) * words_ + static_cast<std::size_t>(x / 64)] >> (x % 64) &
            1) != 0;
  };
  for (int ring = 1; ring < 4; ++ring)
    for (int y = std::max(0, row - ring); y <= std::min(map_.rows - 1, row + ring); ++y)
      for (int x = std::max(0, column - ring); x <= std::min(map_.columns - 1, column + ring); ++x)
        if (named(y, x)) return at(y, x);
  return at(row, column);
}

void Stamp::finish() {
  for (int row = 0; row < map_.rows; ++row)
    for (std::size_t word = 0; word < words_; ++word)
      for (std::uint64_t bits = waiting_[static_cast<std::size_t>(row) * words_ + word]; bits != 0;
           bits &= bits - 1) {
        const int column = static_cast<int>(word) * 64 + std::countr_zero(bits);
        const std::size_t like = nearest(row, column);
        map_.patch[at(row, column)] = map_.patch[like];
        if (streaky_) inked_[at(row, column)] = inked_[like];
      }
  if (!streaky_) return;
  for (std::size_t i = 0; i < inked_.size(); ++i) {
    map_.fresh[i] *= inked_[i];
    map_.contact_s[i] *= inked_[i];
  }
}

}  // namespace fude
