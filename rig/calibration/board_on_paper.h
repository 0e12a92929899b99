// Where a board lies on the paper, by its outermost corners: touched with the calibrated tip, or measured.
#pragma once

#include <filesystem>
#include <optional>
#include <variant>
#include <vector>

#include "calibration/landmarks.h"
#include "calibration/report.h"
#include "rig/calibration/known_calibrations.h"
#include "rig/calibration/tip_touches.h"
#include "signal/pose.h"
#include "signal/result.h"
#include "vision/board.h"

namespace fude {

// Where the board's first corner lies on the paper, and how its rows of corners are turned from the paper's
// x, counter-clockwise: it lies flat.
struct LyingAt {
  double x_mm = 0, y_mm = 0, turn_deg = 0;
};

// A session in which the corners are touched.
struct TouchedCorners {
  std::filesystem::path session;
  TipWish tip;
};

// A list of name,x,y,z in millimetres on the paper.
struct ListedCorners {
  std::filesystem::path list;
};

using BoardPlaceWish = std::variant<LyingAt, TouchedCorners, ListedCorners>;

struct BoardPlace {
  Pose<Paper, BoardFrame> paper_from_board;  // metres
  double radius95_mm = 0;                    // as far the corners put a place of the board wrong
  std::optional<CalibrationReport> by_corners;
};

// The four outermost inner corners in the order in which they are touched or listed: the first, then on
// around the board, along its first row; BoardFrame.
std::vector<Landmark> outermost_corners(const Board& board);

// The board may lean or lie on something: it has six freedoms. `known` has the pivot and the surface of those
// who touch. Errors: those of reading the files and of tip_of; usage where no surface is known; malformed,
// where the corners do not fit the board, with the cause that LandmarkProcedure gives, or face down.
Result<BoardPlace> place_of(const Board& board, const BoardPlaceWish& wish, KnownCalibrations known);

}  // namespace fude
