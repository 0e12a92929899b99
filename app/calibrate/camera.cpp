#include "rig/calibration/camera.h"

#include <CLI/CLI.hpp>
#include <memory>
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

void add_calibrate_camera_pose(CLI::App& calibrate, int& status) {
  struct Options {
    std::string camera;
    BoardOptions board;
    LyingAt lying_at;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command =
      add_procedure(calibrate, status,
                    {"camera-pose", "where a camera stands over the paper, from a board that lies on it",
                     [options](KnownCalibrations known) {
                       return camera_pose_calibrator(
                           {options->camera, options->board.board(), options->lying_at}, std::move(known));
                     }});
  command->add_option("--tool", options->camera, "the camera, where there are several");
  add_board_options(*command, options->board);
  add_numbers_option(
      *command, "--lying-at",
      "x,y of the board's first corner on the paper in mm, and how its rows of corners are turned "
      "there, in degrees counter-clockwise",
      [options](const Eigen::Vector3d& v) {
        options->lying_at = {v.x(), v.y(), v.z()};
      })
      ->required();
}

}  // namespace fude
