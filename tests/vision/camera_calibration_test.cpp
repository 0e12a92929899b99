#include "vision/camera_calibration.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "tests/vision/rendered_board.h"

namespace fude {
namespace {

CameraModel truth() {
  CameraModel camera;
  camera.width = 480;
  camera.height = 360;
  camera.focal_px = {420, 424};
  camera.centre_px = {236, 183};
  camera.distortion = {-0.2, 0.05, 0.001, -0.0005, 0};
  return camera;
}

Board board() {
  Board b;
  b.columns = 8;
  b.rows = 5;
  b.square_m = 0.03;
  return b;
}

// The board's middle at `place`, tilted about its x and y axes.
Pose<Camera, BoardFrame> held(const Eigen::Vector3d& place, double about_x, double about_y) {
  Pose<Camera, BoardFrame> pose;
  pose.rotation = Eigen::AngleAxisd(about_x, Eigen::Vector3d::UnitX()) *
                  Eigen::AngleAxisd(about_y, Eigen::Vector3d::UnitY());
  pose.translation = place - pose.rotation * Eigen::Vector3d(3.5 * 0.03, 2 * 0.03, 0);
  return pose;
}

std::vector<Pose<Camera, BoardFrame>> ways() {
  return {held({0, 0, 0.4}, 0.5, 0),
          held({-0.09, -0.06, 0.45}, -0.4, 0.3),
          held({0.09, 0.06, 0.45}, 0.3, -0.5),
          held({0.09, -0.07, 0.42}, 0.2, 0.5),
          held({-0.09, 0.07, 0.42}, -0.5, -0.2),
          held({0, 0, 0.36}, -0.1, -0.4),
          held({0.02, 0.02, 0.5}, 0.6, 0.2)};
}

std::string name_of(std::size_t view) { return "view " + std::to_string(view); }

CameraCalibration calibrated(const std::vector<Pose<Camera, BoardFrame>>& poses, std::size_t spoilt = 99,
                             const BoardWarp& warp = {}) {
  auto procedure = CameraProcedure::begin(board());
  static const RenderedCamera camera(truth());
  for (std::size_t i = 0; i < poses.size(); ++i)
    procedure->add(camera.picture(board(), poses[i], i == spoilt ? warp : BoardWarp{}), name_of(i));
  return procedure->finish();
}

double rms(const std::vector<double>& values) {
  return std::sqrt(std::inner_product(values.begin(), values.end(), values.begin(), 0.0) /
                   static_cast<double>(values.size()));
}

TEST(CameraCalibration, ARenderedCameraIsFoundAgain) {
  const CameraCalibration found = calibrated(ways());
  ASSERT_TRUE(found.accepted) << found.reason;
  EXPECT_TRUE(found.warnings.empty());
  const CameraModel& camera = found.camera;
  std::printf(
      "figure: camera from rendered boards: rms %.3f px, focal length off by %.2f and %.2f px of 420\n",
      rms(found.residuals_px), camera.focal_px.x() - 420, camera.focal_px.y() - 424);
  EXPECT_LT(rms(found.residuals_px), 0.15);
  EXPECT_LT(found.held_out_rms_px, 0.2);
  // Within four of the deviations that it states, and those are small.
  for (int axis = 0; axis < 2; ++axis) {
    EXPECT_LT(std::abs(camera.focal_px[axis] - truth().focal_px[axis]), 4 * found.focal_deviation_px[axis]);
    EXPECT_LT(std::abs(camera.centre_px[axis] - truth().centre_px[axis]),
              4 * found.centre_deviation_px[axis]);
    EXPECT_LT(found.focal_deviation_px[axis], 1);
    EXPECT_LT(found.centre_deviation_px[axis], 1.5);
  }
  const auto poses = ways();
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const auto& pose = found.views[i].camera_from_board;
    EXPECT_LT((pose.translation - poses[i].translation).norm(), 0.0025) << i;
    EXPECT_LT(pose.rotation.angularDistance(poses[i].rotation), 0.01) << i;
    // A corner of the board is seen where the true camera sees it.
    for (const Eigen::Vector3d& corner : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0.21, 0.12, 0)})
      EXPECT_LT((camera.pixel_of(pose * corner) - truth().pixel_of(poses[i] * corner)).norm(), 0.2) << i;
  }
}

// The corners of one view stand three pixels (at its distance 3 mm) from where they were printed, to and fro.
TEST(CameraCalibration, AViewWhoseCornersAreSpoiltIsNamed) {
  const BoardWarp wavy = [](const Eigen::Vector2d& place) {
    return Eigen::Vector2d(place.x() + 0.003 * std::sin(place.y() / 0.03 * 2.1),
                           place.y() + 0.003 * std::sin(place.x() / 0.03 * 1.7));
  };
  for (const std::size_t spoilt : {std::size_t{0}, std::size_t{4}}) {
    const CameraCalibration found = calibrated(ways(), spoilt, wavy);
    ASSERT_TRUE(found.accepted) << found.reason;
    ASSERT_EQ(found.warnings.size(), 1u);
    EXPECT_TRUE(found.warnings[0].starts_with(name_of(spoilt))) << found.warnings[0];
    EXPECT_LT((found.camera.focal_px - truth().focal_px).norm(), 2);
    for (std::size_t i = 0; i < found.views.size(); ++i) {
      EXPECT_EQ(found.views[i].used && found.views[i].outliers.empty(), i != spoilt) << i;
    }
  }
}

TEST(CameraCalibration, PoorPicturesAreRefusedWithTheCause) {
  const auto all = ways();
  const std::vector<Pose<Camera, BoardFrame>> four(all.begin(), all.begin() + 4);
  EXPECT_NE(calibrated(four).reason.find("found in 4 of 4 pictures, 5 are needed"), std::string::npos);

  std::vector<Pose<Camera, BoardFrame>> parallel;
  for (const double x : {-0.08, -0.03, 0.0, 0.03, 0.08}) parallel.push_back(held({x, x / 2, 0.4}, 0.02, 0));
  const CameraCalibration flat = calibrated(parallel);
  EXPECT_FALSE(flat.accepted);
  EXPECT_NE(flat.reason.find("tilt"), std::string::npos) << flat.reason;

  std::vector<Pose<Camera, BoardFrame>> small;
  for (const double lean : {-0.5, -0.3, 0.0, 0.3, 0.5})
    small.push_back(held({-0.16, -0.12, 0.75 + 0.1 * lean}, lean, -lean));
  const CameraCalibration cornered = calibrated(small);
  EXPECT_FALSE(cornered.accepted);
  EXPECT_NE(cornered.reason.find("of the picture only"), std::string::npos) << cornered.reason;
}

// A film of a board at rest is one view.
TEST(CameraCalibration, AViewLikeOneBeforeAddsNothing) {
  auto procedure = CameraProcedure::begin(board());
  const RenderedCamera camera(truth());
  for (int i = 0; i < 4; ++i) procedure->add(camera.picture(board(), ways()[0]), name_of(0));
  EXPECT_EQ(procedure->add(camera.picture(board(), ways()[1]), name_of(1)).views, 2u);
  EXPECT_EQ(procedure->finish().alike, 3u);
}

TEST(CameraCalibration, PicturesWithoutABoardAreCountedAndHarmless) {
  auto procedure = CameraProcedure::begin(board());
  procedure->add({}, "nothing");
  procedure->add({1, 1, {7}}, "a dot");
  procedure->add({64, 48, std::vector<std::uint8_t>(64 * 48, 90)}, "grey");
  EXPECT_EQ(procedure->finish().boardless.size(), 3u);
  EXPECT_FALSE(procedure->finish().accepted);
}

TEST(CameraCalibration, BoardsThatCannotBeAreRefused) {
  Board b = board();
  b.columns = 2;
  EXPECT_FALSE(CameraProcedure::begin(b));
  b = board();
  b.square_m = 0;
  EXPECT_FALSE(CameraProcedure::begin(b));
  b = board();
  b.kind = BoardKind::charuco;
  b.marker_m = b.square_m;
  EXPECT_FALSE(CameraProcedure::begin(b));
  b.marker_m = 0.02;
  b.dictionary = "DICT_9X9";
  EXPECT_NE(CameraProcedure::begin(b).error().message.find("DICT_4X4_250"), std::string::npos);
  b.dictionary = "DICT_4X4_50";
  b.columns = b.rows = 20;
  EXPECT_NE(CameraProcedure::begin(b).error().message.find("has 50 markers, the board 200"),
            std::string::npos);
}

}  // namespace
}  // namespace fude
