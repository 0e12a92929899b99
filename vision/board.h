// A flat board of known squares, from which a camera is calibrated.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "signal/grey_image.h"
#include "signal/result.h"

namespace fude {

// A board's frame: origin in the first inner corner, x along its rows of corners and y along its columns, z
// into the board away from who looks at it; metres. With a row of `columns` from left to right, the first
// corner is the upper left one: of a chessboard held so that its upper left square is dark.
struct BoardFrame {};

enum class BoardKind : std::uint8_t { chessboard, charuco };

struct Board {
  BoardKind kind = BoardKind::chessboard;
  int columns = 9;  // inner corners of a chessboard, squares of a ChArUco
  int rows = 6;
  double square_m = 0.025;
  double marker_m = 0.019;                  // the side of a ChArUco's marker
  std::string dictionary = "DICT_4X4_250";  // of its markers, as OpenCV names it
};

// Errors: usage, with what is wrong, for a board that cannot be.
Result<void> check(const Board& board);

// Where corner `number` lies, 0 to corners_of() - 1, in BoardFrame (z = 0).
Eigen::Vector2d corner_place_m(const Board& board, int number);
int corners_of(const Board& board);

// Whether a picture tells which corner is the first: not of a chessboard that looks the same upside down, as
// with an even sum of columns and rows.
bool has_one_way_up(const Board& board);

// What one picture shows of the board.
struct BoardView {
  std::string name;                     // of the picture
  std::vector<int> corners;             // numbers of those seen; of a chessboard always all
  std::vector<Eigen::Vector2d> pixels;  // theirs, to a part of a pixel
  bool goes_on = false;                 // a chessboard has squares beyond those that were named
};

// None where the board is not seen well enough: a chessboard as a whole, of a ChArUco at least six corners
// that do not lie on one line. `board` must have passed check().
std::optional<BoardView> find_board(const GreyImage& image, const Board& board);

}  // namespace fude
