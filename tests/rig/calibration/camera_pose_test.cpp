// Pictures of a board that lies on the paper, through a session and a calibration of the lens.
#include "rig/calibration/camera_pose.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "calibration/pose_fields.h"
#include "calibration/surface.h"
#include "capture/session_writer.h"
#include "rig/calibration/calibrate_session.h"
#include "rig/calibration/camera.h"
#include "rig/import_session.h"
#include "tests/fakes/recordings.h"
#include "tests/fakes/scripted_tracker.h"
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

fs::path scratch(const std::string& name) {
  return fs::path(testing::TempDir()) / ("fude-" + std::to_string(getpid()) + "-" + name);
}

KnownCalibrations known(const std::vector<std::string>& tomls) {
  std::vector<fs::path> files;
  for (const std::string& toml : tomls) {
    files.push_back(scratch("known-" + std::to_string(files.size()) + ".toml"));
    std::ofstream(files.back()) << toml;
  }
  auto read = KnownCalibrations::read(files);
  EXPECT_TRUE(read) << read.error().message;
  for (const fs::path& file : files) fs::remove(file);
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

const auto lying = lying_at(0.09, 0.21, std::acos(-1.0) / 18);

Session picture_of_board() { return filmed(RenderedCamera(lens()).picture(board, truth.inverse() * lying)); }

TEST(CalibrateCameraPose, ABoardOnThePaperTellsWhereTheCameraIs) {
  const CameraPoseWish wish{.board = board, .at = LyingAt{90, 210, 10}};
  const auto outcome = calibrated(wish, known({lens_toml("046d:0825:X")}), picture_of_board());
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

// The same board, its corners touched with a tip on a surface that stands anyhow in the tracker's frame.
class TouchedBoard : public testing::Test {
 protected:
  void SetUp() override {
    surface_.width_mm = 420;
    surface_.height_mm = 297;
    surface_.paper_from_tracker = {
        Eigen::Quaterniond(Eigen::AngleAxisd(2, Eigen::Vector3d(1, -2, 0.5).normalized())),
        Eigen::Vector3d(150, -80, 900)};
  }
  void TearDown() override { fs::remove(file_); }

  // In the order given, of outermost_corners().
  void touch(const std::vector<std::size_t>& order) {
    fs::remove(file_);
    auto writer = SessionWriter::create(file_);
    ASSERT_TRUE(writer) << writer.error().message;
    const auto tracker = writer->add_device({.id = "0f44:ff20:A1", .name = "t", .kind = DeviceKind::tracker});
    const auto corners = outermost_corners(board);
    Noise noise(5);
    double t = 0;
    for (const std::size_t corner : order) {
      const Eigen::Vector3d paper_m = lying * corners[corner].at_m;
      const Eigen::Vector3d at_m = 1e-3 * (surface_.paper_from_tracker.inverse() * (1e3 * paper_m));
      const Eigen::Quaterniond turned(
          Eigen::AngleAxisd(0.4, Eigen::Vector3d(1, double(corner), 0).normalized()));
      const Eigen::Vector3d missed = noise.vector(0.2e-3);
      for (int i = 0; i < 20; ++i, t += 0.02)
        ASSERT_TRUE(writer->add_sample(
            *tracker, pose_sample({turned, at_m - turned * tip_m_ + missed + noise.vector(2e-5)}, t)));
    }
    ASSERT_TRUE(writer->close());
  }

  KnownCalibrations calibrations() const {
    CalibrationReport report{.procedure = "surface", .accepted = true, .devices = {"0f44:ff20:A1"}};
    return known({lens_toml("046d:0825:X"), toml_of({to_fields(surface_), report})});
  }

  Result<CalibrationOutcome> placed() const {
    return calibrated({.board = board, .at = TouchedCorners{file_, {{}, tip_m_}}}, calibrations(),
                      picture_of_board());
  }

  const Eigen::Vector3d tip_m_{0.01, 0.002, -0.15};
  SurfaceCalibration surface_;
  fs::path file_ = scratch("touched.fude");
};

TEST_F(TouchedBoard, TellsWhereTheCameraIs) {
  touch({0, 1, 2, 3});
  const auto outcome = placed();
  ASSERT_TRUE(outcome) << outcome.error().message;
  ASSERT_TRUE(outcome->result) << outcome->report.reason;
  const auto found = pose_in<Paper, Camera>(*outcome->result, "paper_from_camera");
  ASSERT_TRUE(found);
  // As far off as the corners put the board, 0.4 m below the camera.
  const auto off = [&](const Eigen::Vector3d& paper_m) {
    return 1e3 * (*found * (truth.inverse() * paper_m) - paper_m).norm();
  };
  const double below_mm = off(lying * Eigen::Vector3d(0.1, 0.06, 0));
  std::printf(
      "figure: a board's corners touched to 0.2 mm: places under it %.2f mm off, within %.2f mm stated\n",
      below_mm, (*outcome->report.ci95)[1]);
  EXPECT_LT(below_mm, 0.5);
  EXPECT_LT(below_mm, (*outcome->report.ci95)[1]);
  EXPECT_LT(found->rotation.angularDistance(truth.rotation), 8e-3);
  EXPECT_TRUE(numbers_in(outcome->report.details, "board_ci95_mm"));
}

TEST_F(TouchedBoard, OfWhichTheOrderIsWrongIsRefusedByName) {
  touch({0, 3, 2, 1});
  const auto around = placed();
  ASSERT_FALSE(around);
  EXPECT_NE(around.error().message.find("the board's corners: "), std::string::npos)
      << around.error().message;
  touch({0, 1, 3, 2});
  const auto crossed = placed();
  ASSERT_FALSE(crossed);
  EXPECT_NE(crossed.error().message.find("touched in the other order"), std::string::npos)
      << crossed.error().message;
  touch({0, 1, 2});
  const auto three = placed();
  ASSERT_FALSE(three);
  EXPECT_NE(three.error().message.find("3 points were measured, but 4"), std::string::npos)
      << three.error().message;
}

TEST_F(TouchedBoard, MayBeMeasuredInstead) {
  const fs::path list = scratch("corners.csv");
  {
    std::ofstream file(list);
    for (const Landmark& corner : outermost_corners(board)) {
      const Eigen::Vector3d mm = 1e3 * (lying * corner.at_m);
      file << corner.name << "," << mm.x() << "," << mm.y() << "," << mm.z() << "\n";
    }
  }
  const auto outcome = calibrated({.board = board, .at = ListedCorners{list}},
                                  known({lens_toml("046d:0825:X")}), picture_of_board());
  ASSERT_TRUE(outcome) << outcome.error().message;
  ASSERT_TRUE(outcome->result) << outcome->report.reason;
  const auto found = pose_in<Paper, Camera>(*outcome->result, "paper_from_camera");
  EXPECT_LT((found->translation - truth.translation).norm(), 2e-3);
  fs::remove(list);
}

TEST(CalibrateCameraPose, WithoutTheLensItSaysWhatToDo) {
  const auto outcome = calibrated({.board = board, .at = LyingAt{}}, {}, picture_of_board());
  ASSERT_FALSE(outcome);
  EXPECT_EQ(outcome.error().fault, Fault::usage);
  EXPECT_NE(outcome.error().message.find("fude calibrate camera first"), std::string::npos);
  const auto other =
      calibrated({.board = board, .at = LyingAt{}}, known({lens_toml("046d:0825:Y")}), picture_of_board());
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
    const auto outcome = calibrated({}, known({toml_of({*camera->result, camera->report})}), one);
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
