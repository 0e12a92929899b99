// Pictures of a board that lies on the paper, through a session and a calibration of the lens.
#include "rig/calibration/camera_pose.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "calibration/pose_fields.h"
#include "rig/calibration/calibrate_session.h"
#include "rig/calibration/camera.h"
#include "rig/import_session.h"
#include "tests/fakes/recordings.h"
#include "tests/vision/rendered_board.h"
#include "vision/camera_pose.h"

namespace fude {
namespace {

namespace fs = std::filesystem;

CameraModel lens() {
  CameraModel camera;
  camera.width = 320;
  camera.height = 240;
  camera.focal_px = {290, 292};
  camera.centre_px = {158, 122};
  camera.distortion = {-0.15, 0.03, 0.001, -0.0005, 0};
  return camera;
}

std::string lens_toml(const std::string& device) {
  const CameraModel camera = lens();
  CalibrationReport report;
  report.procedure = "camera";
  report.accepted = true;
  report.devices = {device};
  return toml_of({{{"width_px", double(camera.width)},
                   {"height_px", double(camera.height)},
                   {"focal_px", std::vector<double>{camera.focal_px.x(), camera.focal_px.y()}},
                   {"centre_px", std::vector<double>{camera.centre_px.x(), camera.centre_px.y()}},
                   {"distortion", std::vector<double>(camera.distortion.begin(), camera.distortion.end())}},
                  report});
}

KnownCalibrations known(const std::string& toml) {
  const fs::path file = fs::path(testing::TempDir()) / ("fude-lens-" + std::to_string(getpid()) + ".toml");
  std::ofstream(file) << toml;
  auto read = KnownCalibrations::read({file});
  EXPECT_TRUE(read) << read.error().message;
  fs::remove(file);
  return read ? std::move(*read) : KnownCalibrations{};
}

Session filmed(const GreyImage& image) {
  Session session;
  session.devices.push_back({1, {.id = "046d:0825:X", .name = "camera", .kind = DeviceKind::camera}});
  CameraFrame frame;
  frame.width = image.width;
  frame.height = image.height;
  session.samples.push_back({1, frame});
  Transfer picture;
  picture.kind = TransferKind::picture;
  for (const std::uint8_t pixel : image.pixels) picture.payload.push_back(std::byte(pixel));
  session.transfers.push_back({1, picture});
  return session;
}

Result<CalibrationOutcome> calibrated(const CameraPoseWish& wish, KnownCalibrations calibrations,
                                      const Session& session) {
  const auto calibrator = camera_pose_calibrator(wish, std::move(calibrations));
  if (!calibrator) return tl::unexpected(calibrator.error());
  return calibrate_session(**calibrator, session);
}

const Board board{.columns = 8, .rows = 5, .square_m = 0.03};

// A camera upright over the paper, 0.45 m high, its picture's upper side away from the painter, leaning.
const Pose<Paper, Camera> truth{
    Eigen::Quaterniond(0, 1, 0, 0) * Eigen::Quaterniond(Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitX())),
    {0.2, -0.06, 0.42}};

Session picture_of_board() {
  const auto lying = lying_at(0.09, 0.21, std::acos(-1.0) / 18);
  return filmed(RenderedCamera(lens()).picture(board, truth.inverse() * lying));
}

TEST(CalibrateCameraPose, ABoardOnThePaperTellsWhereTheCameraIs) {
  const CameraPoseWish wish{.board = board, .lying_at = {90, 210, 10}};
  const auto outcome = calibrated(wish, known(lens_toml("046d:0825:X")), picture_of_board());
  ASSERT_TRUE(outcome) << outcome.error().message;
  ASSERT_TRUE(outcome->result) << outcome->report.reason;
  const auto read = calibration_from_toml(toml_of({*outcome->result, outcome->report}), "test");
  ASSERT_TRUE(read) << read.error().message;
  const auto found = pose_in<Paper, Camera>(read->result, "paper_from_camera");
  ASSERT_TRUE(found);
  EXPECT_LT((found->translation - truth.translation).norm(), 2e-3);
  EXPECT_LT(found->rotation.angularDistance(truth.rotation), 5e-3);
  EXPECT_EQ(outcome->report.unit, "mm");
  EXPECT_LT(outcome->report.rms, 0.5);
}

TEST(CalibrateCameraPose, WithoutTheLensItSaysWhatToDo) {
  const auto outcome = calibrated({.board = board}, {}, picture_of_board());
  ASSERT_FALSE(outcome);
  EXPECT_EQ(outcome.error().fault, Fault::usage);
  EXPECT_NE(outcome.error().message.find("fude calibrate camera first"), std::string::npos);
  const auto other = calibrated({.board = board}, known(lens_toml("046d:0825:Y")), picture_of_board());
  ASSERT_FALSE(other);
  EXPECT_NE(other.error().message.find("046d:0825:Y"), std::string::npos) << other.error().message;
}

TEST(CalibrateCameraPose, ABoardWithoutOneWayUpIsRefusedAtOnce) {
  Board square = board;
  square.columns = 9;
  EXPECT_EQ(camera_pose_calibrator({.board = square}, {}).error().fault, Fault::usage);
}

// Each recorded board as if it lay on a paper.
TEST(CalibrateCameraPose, RecordedBoards) {
  REQUIRE_RECORDING("camera/opencv_left");
  const fs::path file = fs::path(testing::TempDir()) / ("fude-boards-" + std::to_string(getpid()) + ".fude");
  const auto receipt = import_session(recordings() / "camera/opencv_left", file, {.overwrite = true});
  ASSERT_TRUE(receipt) << receipt.error().message;
  const auto all = read_session(file);
  ASSERT_TRUE(all) << all.error().message;
  fs::remove(file);
  const auto calibrator = camera_calibrator({});
  const auto camera = calibrate_session(**calibrator, *all);
  ASSERT_TRUE(camera) << camera.error().message;
  ASSERT_TRUE(camera->result) << camera->report.reason;
  double worst_px = 0, worst_mm = 0;
  for (const RecordedSample& recorded : all->samples) {
    Session one = *all;
    one.samples = {recorded};
    const auto outcome = calibrated({}, known(toml_of({*camera->result, camera->report})), one);
    ASSERT_TRUE(outcome) << outcome.error().message;
    ASSERT_TRUE(outcome->result) << outcome->report.reason;
    worst_px = std::max(worst_px, numbers_in(outcome->report.details, "reprojection_rms_px")->front());
    worst_mm = std::max(worst_mm, (*outcome->report.ci95)[1]);
  }
  std::printf(
      "figure: camera over 13 recorded boards of 25 mm: reprojection at most %.2f px, places within %.2f "
      "mm\n",
      worst_px, worst_mm);
  EXPECT_LT(worst_px, 0.3);
}

}  // namespace
}  // namespace fude
