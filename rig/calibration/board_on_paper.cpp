#include "rig/calibration/board_on_paper.h"

#include <numbers>
#include <utility>

#include "calibration/surface.h"
#include "capture/session.h"
#include "rig/calibration/landmark_file.h"
#include "rig/calibration/undistortion.h"
#include "vision/camera_pose.h"

namespace fude {
namespace {

constexpr double mm_per_m = 1e3;

Result<BoardPlace> fitted(const Board& board, const Points3& corners_m) {
  LandmarkProcedure procedure(outermost_corners(board));
  for (const Eigen::Vector3d& corner : corners_m) procedure.add(corner);
  const auto found = procedure.finish();
  if (!found) return failure(Fault::malformed, "the board's corners: " + found.error().reason);
  const auto back = found->value.inverse();
  BoardPlace place{{back.rotation, back.translation}, (*found->report.ci95)[1], found->report};
  if ((place.paper_from_board.rotation * Eigen::Vector3d::UnitZ()).z() > 0)
    return failure(Fault::malformed,
                   "the board's corners: the board would lie face down; go from its first corner along the "
                   "first row, then on around it");
  return place;
}

Result<SurfaceCalibration> surface_under(const ChosenStream& tool, const std::string& reference,
                                         const KnownCalibrations& known) {
  const auto found = known.find("surface", tool, reference);
  if (!found) return tl::unexpected(found.error());
  if (*found)
    if (auto surface = surface_from((*found)->result)) return std::move(*surface);
  return failure(Fault::usage,
                 "camera-pose needs the surface on which the corners were touched: give --cal SURFACE.toml");
}

Result<BoardPlace> touched(const Board& board, const TouchedCorners& wish, KnownCalibrations known) {
  const auto session = read_session(wish.session);
  if (!session) return tl::unexpected(session.error());
  known.carry(*session);
  TipTouches touches("camera-pose", wish.tip, known);
  for (const RecordedDevice& device : session->devices) touches.begin(device.number, device.description);
  const auto heard = for_each_straight_pose(
      *session, known,
      [&](DeviceNumber device, const PoseSample& pose) { return touches.hear(device, pose); });
  if (!heard) return tl::unexpected(heard.error());
  if (const auto ended = touches.end(); !ended) return tl::unexpected(ended.error());
  const auto surface = surface_under(*touches.poses().tool(), wish.tip.tool.reference, known);
  if (!surface) return tl::unexpected(surface.error());
  Points3 corners;
  for (const TipTouches::Touch& touch : touches.touches(outermost_corners(board).size()))
    corners.push_back(surface->paper_from_tracker * (mm_per_m * touch.point_m) / mm_per_m);
  return fitted(board, corners);
}

}  // namespace

std::vector<Landmark> outermost_corners(const Board& board) {
  const Eigen::Vector2d last = corner_place_m(board, corners_of(board) - 1);
  return {{"the first corner", {0, 0, 0}},
          {"the end of the first row", {last.x(), 0, 0}},
          {"the last corner", {last.x(), last.y(), 0}},
          {"the beginning of the last row", {0, last.y(), 0}}};
}

Result<BoardPlace> place_of(const Board& board, const BoardPlaceWish& wish, KnownCalibrations known) {
  if (const auto* at = std::get_if<LyingAt>(&wish))
    return BoardPlace{
        lying_at(at->x_mm / mm_per_m, at->y_mm / mm_per_m, at->turn_deg * std::numbers::pi / 180), 0, {}};
  if (const auto* corners = std::get_if<TouchedCorners>(&wish))
    return touched(board, *corners, std::move(known));
  const auto listed = read_landmarks(std::get<ListedCorners>(wish).list);
  if (!listed) return tl::unexpected(listed.error());
  Points3 corners;
  for (const Landmark& corner : *listed) corners.push_back(corner.at_m);
  return fitted(board, corners);
}

}  // namespace fude
