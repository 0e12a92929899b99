#include "tests/vision/rendered_board.h"

#include <cmath>

namespace fude {
namespace {

constexpr int looks = 3;  // a side of a pixel
constexpr double black = 30;
constexpr double white = 220;
constexpr double table = 120;

// The direction that falls on a pixel: the lens undone by iteration, which contracts for mild lenses.
Eigen::Vector3d direction_of(const CameraModel& camera, const Eigen::Vector2d& pixel) {
  const Eigen::Vector2d bent = (pixel - camera.centre_px).cwiseQuotient(camera.focal_px);
  Eigen::Vector2d straight = bent;
  for (int step = 0; step < 8; ++step) {
    const Eigen::Vector2d there =
        (camera.pixel_of(straight.homogeneous()) - camera.centre_px).cwiseQuotient(camera.focal_px);
    straight += bent - there;
  }
  return straight.homogeneous();
}

double colour_at(const Board& board, const Eigen::Vector2d& place) {
  const Eigen::Vector2d square = place / board.square_m;  // the first inner corner is at 0, 0
  const Eigen::Vector2d last(board.columns, board.rows);
  if ((square.array() < -2).any() || (square.array() > last.array() + 1).any()) return table;
  if ((square.array() < -1).any() || (square.array() > last.array()).any()) return white;
  const auto number = static_cast<long>(std::floor(square.x()) + std::floor(square.y()));
  return number % 2 == 0 ? black : white;
}

}  // namespace

RenderedCamera::RenderedCamera(const CameraModel& camera) : camera_(camera) {
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x)
      for (int look = 0; look < looks * looks; ++look)
        directions_.push_back(direction_of(
            camera, {x + (look % looks + 0.5) / looks - 0.5, y + (look / looks + 0.5) / looks - 0.5}));
}

GreyImage RenderedCamera::picture(const Board& board, const Pose<Camera, BoardFrame>& camera_from_board,
                                  const BoardWarp& warp) const {
  const auto board_from_camera = camera_from_board.inverse();
  const Eigen::Matrix3d turn = board_from_camera.rotation.toRotationMatrix();
  const Eigen::Vector3d eye = board_from_camera.translation;
  GreyImage image{camera_.width, camera_.height, {}};
  constexpr std::size_t all_looks = looks * looks;
  for (std::size_t first = 0; first < directions_.size(); first += all_looks) {
    double light = 0;
    for (std::size_t look = first; look < first + all_looks; ++look) {
      const Eigen::Vector3d ray = turn * directions_[look];
      const Eigen::Vector2d place = (eye - ray * (eye.z() / ray.z())).head<2>();
      light += colour_at(board, warp ? warp(place) : place);
    }
    image.pixels.push_back(static_cast<std::uint8_t>(std::lround(light / all_looks)));
  }
  return image;
}

}  // namespace fude
