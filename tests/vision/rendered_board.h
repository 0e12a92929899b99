// Pictures of a chessboard as a known camera would take them: the truth that a calibration must find again.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "signal/camera_model.h"
#include "signal/grey_image.h"
#include "signal/pose.h"
#include "vision/board.h"

namespace fude {

// Where the ink of a board that is not flat, or not as it should be, really lies: from a place on the printed
// board (metres, BoardFrame) to the place whose colour is seen there.
using BoardWarp = std::function<Eigen::Vector2d(const Eigen::Vector2d&)>;

class RenderedCamera {
 public:
  explicit RenderedCamera(const CameraModel& camera);

  // Squares with a white rim on a grey table; nine looks a pixel, so that edges are grey as through a lens.
  GreyImage picture(const Board& board, const Pose<Camera, BoardFrame>& camera_from_board,
                    const BoardWarp& warp = {}) const;

 private:
  CameraModel camera_;
  std::vector<Eigen::Vector3d> directions_;  // of every look of every pixel
};

}  // namespace fude
