#include "rig/calibration/camera.h"

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "app/calibrate/board_options.h"
#include "app/calibrate/procedure_command.h"
#include "app/calibrate/procedures.h"

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

}  // namespace fude
