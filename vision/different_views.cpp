#include "vision/different_views.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace fude {
namespace {

constexpr double alike_share = 0.02;

// How far the corners of one view lie from those of the other, in shares of the board's length in the
// picture.
double apart(const BoardView& a, const BoardView& b) {
  const double length = (a.pixels.back() - a.pixels.front()).norm();
  double moved = 0;
  int common = 0;
  for (std::size_t i = 0; i < a.corners.size(); ++i) {
    const auto at = std::ranges::find(b.corners, a.corners[i]);
    if (at == b.corners.end()) continue;
    moved += (a.pixels[i] - b.pixels[static_cast<std::size_t>(at - b.corners.begin())]).norm();
    ++common;
  }
  return common > 0 ? moved / (length * common) : 1;
}

double nearest(const std::vector<BoardView>& views, const BoardView& view) {
  double least = std::numeric_limits<double>::infinity();
  for (const BoardView& other : views)
    if (&other != &view) least = std::min(least, apart(view, other));
  return least;
}

// The view that lies nearest to another, the later of the two.
std::size_t most_redundant(const std::vector<BoardView>& views) {
  std::size_t redundant = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < views.size(); ++i)
    if (const double here = nearest(views, views[i]); here <= least) {
      least = here;
      redundant = i;
    }
  return redundant;
}

}  // namespace

void DifferentViews::add(BoardView view) {
  const double away = nearest(kept_, view);
  if (away < alike_share) {
    ++passed_over_;
    return;
  }
  if (kept_.size() == most_) {
    ++passed_over_;
    const std::size_t redundant = most_redundant(kept_);
    if (away <= nearest(kept_, kept_[redundant])) return;
    kept_.erase(kept_.begin() + static_cast<std::ptrdiff_t>(redundant));
  }
  kept_.push_back(std::move(view));
}

}  // namespace fude
