#include "sim/brush/winding_fill.h"

#include <algorithm>
#include <utility>

namespace fude {

using Eigen::Vector2d;

namespace {

// The first sample whose centre is not below y, y of either sign.
int first_sample(double y) {
  const double shifted = y - 0.5;
  const int towards_zero = static_cast<int>(shifted);
  return towards_zero + (towards_zero < shifted ? 1 : 0);
}

constexpr double fixed_point = 4294967296.0;
constexpr std::int64_t half = std::int64_t{1} << 31;

}  // namespace

int turn_of(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x()) < 0 ? -1 : 1;
}

void WindingFill::start(const CoverageFrame& frame) {
  frame_ = frame;
  scale_ = samples_per_side / frame.cell_mm;
  edges_.clear();
}

void WindingFill::add_edge(const Vector2d& from, const Vector2d& to, int weight) {
  // Always walked upwards: what two pieces share crosses every row at the same bits.
  const bool up = from.y() < to.y();
  const Vector2d low = (up ? from : to) * scale_;
  const Vector2d high = (up ? to : from) * scale_;
  const auto bottom = static_cast<int>(frame_.first_row * samples_per_side);
  const int last = frame_.rows * samples_per_side;
  const int first_row = std::clamp(first_sample(low.y()) - bottom, 0, last);
  const int end_row = std::clamp(first_sample(high.y()) - bottom, 0, last);
  if (first_row >= end_row) return;
  const double slope = (high.x() - low.x()) / (high.y() - low.y());
  const double x = low.x() + (bottom + first_row + 0.5 - low.y()) * slope;
  edges_.push_back({static_cast<std::int64_t>(x * fixed_point),
                    end_row - first_row > 1 ? static_cast<std::int64_t>(slope * fixed_point) : 0, first_row,
                    end_row, up ? weight : -weight});
}

void WindingFill::add_quad(const Vector2d& a, const Vector2d& b, const Vector2d& c, const Vector2d& d) {
  const int abc = turn_of(a, b, c);
  const int acd = turn_of(a, c, d);
  add_edge(a, b, abc);
  add_edge(b, c, abc);
  add_edge(c, d, acd);
  add_edge(d, a, acd);
  if (abc != acd) add_edge(a, c, acd - abc);
}

void WindingFill::fill(Coverage& cover) {
  const auto rows = static_cast<std::size_t>(frame_.rows * samples_per_side);
  begin_.assign(rows + 1, 0);
  for (const Edge& e : edges_) {
    ++begin_[static_cast<std::size_t>(e.first_row)];
    --begin_[static_cast<std::size_t>(e.end_row)];
  }
  int active = 0;
  int total = 0;
  for (int& begin : begin_) {
    active += begin;
    begin = total;
    total += active;
  }
  next_ = begin_;
  crossings_.resize(static_cast<std::size_t>(total));
  const auto left = static_cast<int>(frame_.first_word * samples_per_word);
  const int width = frame_.words * samples_per_word;
  for (const Edge& e : edges_) {
    std::int64_t x = e.x + half;  // a sample is in from its centre on
    for (int row = e.first_row; row < e.end_row; ++row, x += e.by_row) {
      const int column = std::clamp(static_cast<int>(x >> 32) - left, 0, width);
      crossings_[static_cast<std::size_t>(next_[static_cast<std::size_t>(row)]++)] = {column, e.weight};
    }
  }
  for (std::size_t row = 0; row < rows; ++row) {
    const auto first = crossings_.begin() + begin_[row];
    const auto last = crossings_.begin() + begin_[row + 1];
    for (auto i = first; i != last; ++i)  // few, and nearly in order
      for (auto j = i; j != first && j->column < (j - 1)->column; --j) std::swap(*j, *(j - 1));
    int winding = 0;
    int from = 0;
    for (auto crossing = first; crossing != last; ++crossing) {
      if (winding == 0) from = crossing->column;
      winding += crossing->weight;
      if (winding == 0 && from < crossing->column)
        cover.add_span(static_cast<int>(row), from, crossing->column);
    }
  }
  edges_.clear();
}

}  // namespace fude
