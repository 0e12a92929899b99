#include "vision/printed_board.h"

#include <opencv2/aruco/charuco.hpp>

#include "vision/board_dictionary.h"

namespace fude {
namespace {

constexpr int pixels_per_square = 120;

std::vector<BlackArea> chessboard(const Board& board) {
  std::vector<BlackArea> areas;
  const Eigen::Vector2d square = Eigen::Vector2d::Constant(board.square_m);
  for (int row = 0; row <= board.rows; ++row)
    for (int column = row % 2; column <= board.columns; column += 2)
      areas.push_back({board.square_m * Eigen::Vector2d(column, row), square});
  return areas;
}

// A picture by OpenCV in which places are looked up in shares of a square.
class Drawn {
 public:
  explicit Drawn(const Board& board) {
    charuco_board(board)->draw({board.columns * pixels_per_square, board.rows * pixels_per_square}, picture_);
  }
  bool black(const Eigen::Vector2d& at) const {
    return picture_.at<std::uint8_t>(int(at.y() * pixels_per_square), int(at.x() * pixels_per_square)) < 128;
  }

 private:
  cv::Mat picture_;
};

// The bits of a marker with its border, in the middle of a white square.
void add_marker(std::vector<BlackArea>& areas, const Board& board, const Drawn& drawn,
                const Eigen::Vector2d& square) {
  const int modules = marker_modules(board);
  const double side = board.marker_m / board.square_m, module = side / modules;
  const Eigen::Vector2d corner = square + Eigen::Vector2d::Constant((1 - side) / 2);
  for (int row = 0; row < modules; ++row)
    for (int first = 0; first < modules; ++first) {
      int end = first;
      const auto black = [&](int column) {
        return drawn.black(corner + module * Eigen::Vector2d(column + 0.5, row + 0.5));
      };
      while (end < modules && black(end)) ++end;
      if (end == first) continue;
      areas.push_back({board.square_m * (corner + module * Eigen::Vector2d(first, row)),
                       board.square_m * module * Eigen::Vector2d(end - first, 1)});
      first = end;
    }
}

}  // namespace

Eigen::Vector2d printed_size_m(const Board& board) {
  const int beyond = board.kind == BoardKind::chessboard ? 1 : 0;
  return board.square_m * Eigen::Vector2d(board.columns + beyond, board.rows + beyond);
}

Result<std::vector<BlackArea>> black_areas(const Board& board) {
  if (const auto sound = check(board); !sound) return tl::unexpected(sound.error());
  if (board.kind == BoardKind::chessboard) return chessboard(board);
  const Drawn drawn(board);
  std::vector<BlackArea> areas;
  for (int row = 0; row < board.rows; ++row)
    for (int column = 0; column < board.columns; ++column) {
      const Eigen::Vector2d square(column, row);
      constexpr double beside_marker = 0.01;
      if (drawn.black(square + Eigen::Vector2d::Constant(beside_marker)))
        areas.push_back({board.square_m * square, Eigen::Vector2d::Constant(board.square_m)});
      else
        add_marker(areas, board, drawn, square);
    }
  return areas;
}

}  // namespace fude
