#include "rig/calibration/camera.h"

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "app/calibrate/board_options.h"
#include "app/calibrate/procedure_command.h"
#include "app/calibrate/procedures.h"
#include "app/numbers_option.h"
#include "rig/calibration/camera_pose.h"

namespace fude {

void add_calibrate_camera(CLI::App& calibrate, int& status) {
  struct Options {
    std::string camera;
    BoardOptions board;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command =
      add_procedure(calibrate, status,
                    {"camera", "focal lengths, centre and distortion, from pictures of a board",
                     [options](const KnownCalibrations&) {
                       return camera_calibrator({options->camera, options->board.board()});
                     }});
  command->add_option("--tool", options->camera, "the camera, where there are several");
  add_board_options(*command, options->board);
}

namespace {

struct PoseOptions {
  std::string camera;
  BoardOptions board;
  std::optional<LyingAt> lying_at;
  TouchedCorners touched;
  ListedCorners listed;

  Result<std::unique_ptr<Calibrator>> calibrator(KnownCalibrations known) const {
    CameraPoseWish wish{camera, board.board(), {}};
    if (lying_at)
      wish.at = *lying_at;
    else if (!touched.session.empty())
      wish.at = touched;
    else if (!listed.list.empty())
      wish.at = listed;
    else
      return failure(Fault::usage,
                     "say where the board lies: --touched SESSION, in which its four outermost corners are "
                     "touched, --corners-at FILE, or --lying-at x,y,turn");
    return camera_pose_calibrator(wish, std::move(known));
  }
};

}  // namespace

void add_calibrate_camera_pose(CLI::App& calibrate, int& status) {
  auto options = std::make_shared<PoseOptions>();
  CLI::App* command =
      add_procedure(calibrate, status,
                    {"camera-pose", "where a camera stands over the paper, from a board that lies on it",
                     [options](KnownCalibrations known) { return options->calibrator(std::move(known)); }});
  command->add_option("--tool", options->camera, "the camera, where there are several");
  add_board_options(*command, options->board);
  auto* touched = command->add_option(
      "--touched", options->touched.session,
      "a session in which the board's four outermost inner corners are touched with the calibrated tip: the "
      "first, along the first row, and on around the board");
  command->add_option("--by", options->touched.tip.tool.tool,
                      "the tool that touches, where there are several");
  command->add_option("--reference", options->touched.tip.tool.reference,
                      "the tool that stands for the tracker's frame");
  add_tip_option(*command, options->touched.tip.tip_m);
  auto* listed =
      command->add_option("--corners-at", options->listed.list,
                          "instead: a list of name,x,y,z of the four in mm on the paper, in the same order");
  auto* lying = add_numbers_option(
      *command, "--lying-at",
      "instead: x,y of the board's first corner on the paper in mm, and how its rows of corners are turned "
      "there, in degrees counter-clockwise",
      [options](const Eigen::Vector3d& v) {
        options->lying_at = {v.x(), v.y(), v.z()};
      });
  listed->excludes(touched);
  lying->excludes(touched)->excludes(listed);
}

}  // namespace fude
