// Where a camera stands over the paper, from a picture of a board that lies on it in a known place.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "signal/camera_model.h"
#include "signal/grey_image.h"
#include "signal/pose.h"
#include "signal/result.h"
#include "vision/board.h"

namespace fude {

// A board flat on the paper, its printed side up: its first corner at x, y of the paper (metres), its rows of
// corners turned by `turn_rad` from the paper's x, counter-clockwise as the painter sees it.
Pose<Paper, BoardFrame> lying_at(double x_m, double y_m, double turn_rad);

struct CameraPlacement {
  Pose<Paper, Camera> paper_from_camera;  // metres
  std::vector<double> residuals_mm;       // of the corners used, on the paper
  double rms_px = 0;                      // of the same in the picture
  double held_out_rms_mm = 0;             // of half of the corners by a fit of the others
  double radius95_mm = 0;        // as far the camera puts a place of the paper wrong, at the worst corner
  double camera_radius95_m = 0;  // of the camera's own place
  double condition = 0;          // of the equations, each unknown in its own measure
  double share_of_picture = 0;   // that the board fills
  std::size_t pictures = 0;      // used
  std::vector<std::string> boardless, moved;  // pictures without the board; with it elsewhere
  std::size_t corners_left_out = 0;
  bool accepted = false;
  std::string reason;
  std::vector<std::string> warnings;
};

class CameraPoseProcedure {
 public:
  struct Progress {
    std::size_t pictures = 0;  // with the board
    std::string missing;
  };

  // `camera`: its lens, at the focus of the pictures. Errors: usage, as of check(board), and for a board of
  // which no picture tells which way up it lies.
  static Result<CameraPoseProcedure> begin(const Board& board, const CameraModel& camera,
                                           const Pose<Paper, BoardFrame>& paper_from_board);

  // Neither camera nor board moves from picture to picture: their corners are averaged.
  Progress add(const GreyImage& image, const std::string& name);

  // Refused: no picture of the board; pictures of another size than the lens was calibrated with; a camera or
  // a board that moved; two poses that explain the picture alike; residuals above 1 px; places of the paper
  // known to worse than 2 mm.
  CameraPlacement finish() const;

 private:
  CameraPoseProcedure(const Board& board, const CameraModel& camera,
                      const Pose<Paper, BoardFrame>& paper_from_board)
      : board_(board), camera_(camera), paper_from_board_(paper_from_board) {}

  Board board_;
  CameraModel camera_;
  Pose<Paper, BoardFrame> paper_from_board_;
  std::vector<BoardView> views_;
  std::vector<std::string> boardless_;
  std::optional<std::string> other_size_;  // of pictures that the lens was not calibrated for
};

}  // namespace fude
