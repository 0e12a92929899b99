#include "sim/brush/stamp.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "sim/brush/loading.h"
#include "sim/brush/scanline.h"

namespace fude {

using Eigen::Vector2d;

Stamp::Stamp(const CoverageFrame& frame, const HairTexture& texture, const std::vector<InkLoad>& loads,
             FootprintMap& map)
    : frame_(frame), texture_(texture), loads_(loads), map_(map) {
  map.patch.assign(map.fresh.size(), 0);
  for (const InkLoad& load : loads)
    streaky_ = streaky_ || static_cast<double>(load.wetness) < texture.streak_wetness();
  if (streaky_) inked_.assign(map.fresh.size(), 1);
  words_ = static_cast<std::size_t>(frame_.columns() + 63) / 64;
  waiting_.assign(words_ * static_cast<std::size_t>(map.rows), 0);
  named_.assign(waiting_.size(), 0);
}

void Stamp::wait_for(const Coverage& cover) {
  constexpr int in_word = 64 / cells_per_word;
  for (int row = 0; row < frame_.rows; ++row)
    for (int word = 0; word < frame_.words; ++word) {
      if (!cover.any(row, word)) continue;
      const std::size_t i = static_cast<std::size_t>(row) * words_ + static_cast<std::size_t>(word / in_word);
      const std::uint64_t cells = cover.whole(row, word) ? 0xffff : cover.cells(row, word);
      waiting_[i] |= cells << (word % in_word * cells_per_word) & ~named_[i];
    }
}

bool Stamp::waits() const {
  return std::any_of(waiting_.begin(), waiting_.end(), [](std::uint64_t bits) { return bits != 0; });
}

// Calls take(first, end) for each stretch of cells that wait in [first, end); they wait no longer.
template <class Take>
void Stamp::take_waiting(int row, int first, int end, Take take) {
  for (int word = first / 64; word * 64 < end; ++word) {
    const std::size_t i = static_cast<std::size_t>(row) * words_ + static_cast<std::size_t>(word);
    std::uint64_t bits = waiting_[i] & ~std::uint64_t{0} << std::max(first - word * 64, 0);
    if (end - word * 64 < 64) bits &= ~(~std::uint64_t{0} << (end - word * 64));
    if (bits == 0) continue;
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

MeshPoint Stamp::in_cells(const MeshPoint& p) const {
  return {(p.at - Vector2d(frame_.left_mm(), frame_.bottom_mm())) / frame_.cell_mm, p.on_tuft};
}

void Stamp::add(const Contact& contact) {
  const auto corner = [&](const ContactRing& ring, std::size_t j) {
    return in_cells({ring.point[j], {ring.along, ring.around[j]}});
  };
  for (std::size_t r = 0; r < contact.run_ends.size(); ++r) {
    const auto run = contact.run(r);
    for (std::size_t i = 1; i < run.size(); ++i)
      for (std::size_t j = 1; j < ring_points; ++j) {
        add_quad(corner(run[i - 1], j - 1), corner(run[i - 1], j), corner(run[i], j), corner(run[i], j - 1));
      }
  }
}

void Stamp::add_passage(const ContactMesh& from, const ContactMesh& to) {
  for_each_passage(from, to,
                   [&](const MeshPoint& a, const MeshPoint& b, const MeshPoint& c, const MeshPoint& d) {
                     add_quad(in_cells(a), in_cells(b), in_cells(c), in_cells(d));
                   });
}

void Stamp::add_quad(const MeshPoint& a, const MeshPoint& b, const MeshPoint& c, const MeshPoint& d) {
  const Vector2d low = a.at.cwiseMin(b.at).cwiseMin(c.at.cwiseMin(d.at));
  const Vector2d high = a.at.cwiseMax(b.at).cwiseMax(c.at.cwiseMax(d.at));
  const auto first_word = static_cast<std::size_t>(std::max(low.x(), 0.0)) / 64;
  const auto end_word = std::min(static_cast<std::size_t>(std::max(high.x(), 0.0)) / 64 + 1, words_);
  const auto first_row = static_cast<std::size_t>(std::max(low.y(), 0.0));
  const auto end_row =
      std::min(static_cast<std::size_t>(std::max(high.y(), 0.0)) + 1, static_cast<std::size_t>(map_.rows));
  std::uint64_t any = 0;
  for (std::size_t row = first_row; row < end_row; ++row)
    for (std::size_t word = first_word; word < end_word; ++word) any |= waiting_[row * words_ + word];
  if (any == 0) return;
  add_triangle(a, b, c);
  add_triangle(a, c, d);
}

// The place on the tuft goes over linearly within a triangle.
void Stamp::add_triangle(const MeshPoint& a, const MeshPoint& b, const MeshPoint& c) {
  const Vector2d u = b.at - a.at;
  const Vector2d v = c.at - a.at;
  const double area = u.x() * v.y() - u.y() * v.x();
  if (std::abs(area) < 1e-12) return;
  const Vector2d by_u = (b.on_tuft - a.on_tuft) / area;
  const Vector2d by_v = (c.on_tuft - a.on_tuft) / area;
  const Vector2d by_x = v.y() * by_u - u.y() * by_v;
  const Vector2d by_y = u.x() * by_v - v.x() * by_u;
  scan_triangle(a.at, b.at, c.at, map_.rows, [&](int row, double from, double to) {
    const int first = first_centre(from, map_.columns);
    const int end = first_centre(to, map_.columns);
    std::uint16_t* patches = map_.patch.data() + at(row, 0);
    take_waiting(row, first, end, [&](int from_column, int end_column) {
      const Vector2d start = a.on_tuft + (row + 0.5 - a.at.y()) * by_y - a.at.x() * by_x;
      const auto patch = [&](int column) {
        const Vector2d place = start + (column + 0.5) * by_x;
        return static_cast<std::uint16_t>(patch_at(place[0], place[1]));
      };
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
