// A camera from pictures of a board: focal lengths, centre and lens distortion, and how sure that is (Zhang
// 2000; the fit is OpenCV's).
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "signal/camera_model.h"
#include "signal/pose.h"
#include "signal/result.h"
#include "vision/board.h"
#include "vision/different_views.h"

namespace fude {

// One picture's part in the fit.
struct FittedView {
  std::string name;
  double rms_px = 0;  // of the distances between its corners and where the model sees them
  std::size_t corners = 0;
  std::vector<int> outliers;  // corners that the fit left out, by number
  bool used = true;           // false: the whole view is an outlier
  Pose<Camera, BoardFrame> camera_from_board;
};

struct CameraCalibration {
  CameraModel camera;
  Eigen::Vector2d focal_deviation_px = Eigen::Vector2d::Zero();  // one standard deviation
  Eigen::Vector2d centre_deviation_px = Eigen::Vector2d::Zero();
  std::vector<FittedView> views;
  std::vector<std::string> boardless;  // pictures in which no board was found
  std::size_t alike = 0;               // views passed over, or given up for another
  std::vector<double> residuals_px;    // distances, over the corners used
  double held_out_rms_px = 0;          // of views that a fit of the others did not see; corners as distances
  double coverage = 0;                 // share of the picture, in cells, where corners were
  std::string coverage_map;            // the cells, row by row: '#' with corners, '.' without
  double tilt_rad = 0;                 // the largest angle between two boards
  bool accepted = false;
  std::string reason;
  std::vector<std::string> warnings;
};

class CameraProcedure {
 public:
  struct Progress {
    std::size_t views = 0;
    double covered = 0;   // share of what finish() needs, 0 to 1
    std::string missing;  // what to show the camera next; empty where nothing is
  };

  // Errors: usage, as of check(board).
  static Result<CameraProcedure> begin(const Board& board);

  // Any picture, with the board or without; `name` stands for it in the report. All are of the size of the
  // first: others count as boardless. A view that hardly differs from one before tells nothing new and is
  // passed over. Of a film's thousands 60 are kept: a later one takes the place of the one most like another,
  // where it differs more.
  Progress add(const GreyImage& image, const std::string& name);

  // Refused (accepted false, and why): fewer than 5 views of the board, less than half of the picture
  // covered, boards within 15 degrees of each other, a focal length known to worse than 1 %, residuals above
  // 1 px. A view whose corners stand away from the rest is named in the warnings and left out.
  CameraCalibration finish() const;

 private:
  explicit CameraProcedure(const Board& board) : board_(board) {}

  Board board_;
  std::int32_t width_ = 0;
  std::int32_t height_ = 0;
  DifferentViews views_{60};
  std::vector<std::string> boardless_;
  std::size_t goes_on_ = 0;  // views with squares beyond those that were named
};

}  // namespace fude
