#include "vision/camera_pose.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdio>

#include "signal/units.h"
#include "tests/vision/rendered_board.h"

namespace fude {
namespace {

CameraModel lens() {
  CameraModel camera;
  camera.width = 480;
  camera.height = 360;
  camera.focal_px = {420, 424};
  camera.centre_px = {236, 183};
  camera.distortion = {-0.2, 0.05, 0.001, -0.0005, 0};
  return camera;
}

Board board(int columns = 8, int rows = 5) {
  Board b;
  b.columns = columns;
  b.rows = rows;
  b.square_m = 0.03;
  return b;
}

// A camera at `from` over the paper that looks at `to` on it, its picture level.
Pose<Paper, Camera> looking(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double roll_rad = 0) {
  const Eigen::Vector3d z = (to - from).normalized();
  const Eigen::Vector3d x = z.cross(Eigen::Vector3d::UnitZ()).normalized();
  Eigen::Matrix3d axes;
  axes << x, z.cross(x), z;
  return {
      Eigen::Quaterniond(axes) * Eigen::Quaterniond(Eigen::AngleAxisd(roll_rad, Eigen::Vector3d::UnitZ())),
      from};
}

const Pose<Paper, BoardFrame> lying = lying_at(0.08, 0.21, 0.2);
const Pose<Paper, Camera> above = looking({0.15, -0.12, 0.42}, {0.19, 0.17, 0});

CameraPlacement placed(const Pose<Paper, Camera>& truth, const Board& real = board(),
                       const Board& named = board(), int pictures = 1) {
  static const RenderedCamera camera(lens());
  auto procedure = CameraPoseProcedure::begin(named, lens(), lying);
  EXPECT_TRUE(procedure);
  for (int i = 0; i < pictures; ++i)
    procedure->add(camera.picture(real, truth.inverse() * lying), "picture " + std::to_string(i + 1));
  return procedure->finish();
}

TEST(CameraPose, ABoardLiesFaceUpWhereItIsSaid) {
  const auto pose = lying_at(0.1, 0.2, 0);
  EXPECT_LT((pose * Eigen::Vector3d(0.05, 0.02, 0) - Eigen::Vector3d(0.15, 0.18, 0)).norm(), 1e-12);
  EXPECT_LT((pose.rotation * Eigen::Vector3d::UnitZ() + Eigen::Vector3d::UnitZ()).norm(), 1e-12);
  const auto turned = lying_at(0, 0, std::acos(-1.0) / 2);
  EXPECT_LT((turned * Eigen::Vector3d(0.05, 0, 0) - Eigen::Vector3d(0, 0.05, 0)).norm(), 1e-12);
}

TEST(CameraPose, ARenderedCameraIsFoundOverThePaper) {
  const double half_turn = std::acos(-1.0);
  // From the painter's side; from the other, where the board is upside down in the picture; rolled.
  for (const auto& truth : {above, looking({0.2, 0.52, 0.36}, {0.19, 0.17, 0}),
                            looking({0.15, -0.12, 0.42}, {0.19, 0.17, 0}, half_turn)}) {
    const CameraPlacement found = placed(truth);
    ASSERT_TRUE(found.accepted) << found.reason;
    EXPECT_TRUE(found.warnings.empty()) << found.warnings[0];
    const double off_mm = 1e3 * (found.paper_from_camera.translation - truth.translation).norm();
    const double off_deg =
        in_degrees(Radians(found.paper_from_camera.rotation.angularDistance(truth.rotation)));
    std::printf(
        "figure: camera over the paper, rendered: %.2f mm and %.3f degrees off, reprojection %.3f px, paper "
        "within %.2f mm, camera within %.2f mm\n",
        off_mm, off_deg, found.rms_px, found.radius95_mm, 1e3 * found.camera_radius95_m);
    EXPECT_LT(off_mm, 1);
    EXPECT_LT(off_mm, 2e3 * found.camera_radius95_m);
    EXPECT_LT(off_deg, 0.15);
    EXPECT_LT(found.rms_px, 0.15);
    EXPECT_LT(found.held_out_rms_mm, 0.3);
    EXPECT_LT(found.radius95_mm, 0.3);
    EXPECT_EQ(found.residuals_mm.size(), 40u);
  }
}

TEST(CameraPose, ABoardThatLooksTheSameUpsideDownIsRefusedByName) {
  const auto procedure = CameraPoseProcedure::begin(board(8, 6), lens(), lying);
  ASSERT_FALSE(procedure);
  EXPECT_NE(procedure.error().message.find("8 x 6 inner corners looks the same upside down"),
            std::string::npos);
}

// OpenCV finds a part of a larger board now and then; it must not go unnoticed.
TEST(FoundBoard, ThatGoesOnBeyondWhatWasNamedSaysSo) {
  static const RenderedCamera camera(lens());
  int parts = 0;
  for (const Eigen::Vector3d& from : {Eigen::Vector3d(0.15, -0.12, 0.42), Eigen::Vector3d(0.2, 0.2, 0.36)}) {
    const auto picture = camera.picture(board(9, 6), looking(from, {0.19, 0.17, 0}).inverse() * lying);
    const auto whole = find_board(picture, board(9, 6)), part = find_board(picture, board(8, 6));
    ASSERT_TRUE(whole);
    EXPECT_FALSE(whole->goes_on);
    if (!part) continue;
    ++parts;
    EXPECT_TRUE(part->goes_on);
  }
  EXPECT_GT(parts, 0) << "no part of the larger board was found in any view";
}

TEST(CameraPose, APictureTakenElsewhereIsNamed) {
  static const RenderedCamera camera(lens());
  auto procedure = CameraPoseProcedure::begin(board(), lens(), lying);
  for (int i = 0; i < 3; ++i) procedure->add(camera.picture(board(), above.inverse() * lying), "still");
  procedure->add(camera.picture(board(), looking({0.17, -0.12, 0.4}, {0.19, 0.17, 0}).inverse() * lying),
                 "nudged");
  const CameraPlacement found = procedure->finish();
  ASSERT_TRUE(found.accepted) << found.reason;
  EXPECT_EQ(found.pictures, 3u);
  ASSERT_EQ(found.moved.size(), 1u);
  EXPECT_EQ(found.moved[0], "nudged");
}

TEST(CameraPose, WhatCannotBeIsRefusedWithTheCause) {
  auto procedure = CameraPoseProcedure::begin(board(), lens(), lying);
  procedure->add({480, 360, std::vector<std::uint8_t>(480 * 360, 90)}, "grey");
  EXPECT_NE(procedure->finish().reason.find("in none of 1 pictures"), std::string::npos);
  procedure = CameraPoseProcedure::begin(board(), lens(), lying);
  procedure->add({64, 48, std::vector<std::uint8_t>(64 * 48, 90)}, "small");
  EXPECT_NE(procedure->finish().reason.find("64 x 48, the lens was calibrated with 480 x 360"),
            std::string::npos);

  // Another lens than that of the picture.
  CameraModel other = lens();
  other.focal_px = {420, 640};
  procedure = CameraPoseProcedure::begin(board(), other, lying);
  procedure->add(RenderedCamera(lens()).picture(board(), above.inverse() * lying), "picture 1");
  const CameraPlacement found = procedure->finish();
  EXPECT_FALSE(found.accepted);
  EXPECT_NE(found.reason.find("is it this camera's"), std::string::npos) << found.reason;
}

}  // namespace
}  // namespace fude
