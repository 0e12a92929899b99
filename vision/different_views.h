// The views of a board that tell most: a film gives thousands, most of them like another.
#pragma once

#include <cstddef>
#include <vector>

#include "vision/board.h"

namespace fude {

class DifferentViews {
 public:
  explicit DifferentViews(std::size_t most) : most_(most) {}

  // A view whose corners lie where those of one before do, but for 2 % of the board's length in the picture,
  // is passed over. When there are enough, a view takes the place of the one most like another, where it
  // differs more; of two that are alike the later goes.
  void add(BoardView view);

  const std::vector<BoardView>& kept() const { return kept_; }  // in the order they came
  std::size_t passed_over() const { return passed_over_; }      // or given up for another

 private:
  std::size_t most_;
  std::vector<BoardView> kept_;
  std::size_t passed_over_ = 0;
};

}  // namespace fude
