// A board as it is printed.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "signal/result.h"
#include "vision/board.h"

namespace fude {

// Metres from the upper left corner of the board, x to the right and y down.
struct BlackArea {
  Eigen::Vector2d corner_m;  // its upper left one
  Eigen::Vector2d size_m;
};

// The whole board, with the squares around the inner corners of a chessboard.
Eigen::Vector2d printed_size_m(const Board& board);

// Everything on it that is black, rectangles that may touch but do not overlap. What OpenCV draws of a
// ChArUco is what is printed. Errors: usage, as of check(board).
Result<std::vector<BlackArea>> black_areas(const Board& board);

}  // namespace fude
