#include "rig/calibration/camera.h"

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "app/calibrate/procedure_command.h"
#include "app/calibrate/procedures.h"

namespace fude {
namespace {

struct Options {
  CameraWish wish;
  std::string board = "chessboard";
  double square_mm = 25;
  double marker_mm = 0;  // 0: three quarters of a square

  CameraWish wished() const {
    CameraWish wished = wish;
    wished.board.kind = board == "charuco" ? BoardKind::charuco : BoardKind::chessboard;
    wished.board.square_m = 1e-3 * square_mm;
    wished.board.marker_m = marker_mm > 0 ? 1e-3 * marker_mm : 0.75 * wished.board.square_m;
    return wished;
  }
};

}  // namespace

void add_calibrate_camera(CLI::App& calibrate, int& status) {
  auto options = std::make_shared<Options>();
  Board& board = options->wish.board;
  CLI::App* command =
      add_procedure(calibrate, status,
                    {"camera", "focal lengths, centre and distortion, from pictures of a board",
                     [options](const KnownCalibrations&) { return camera_calibrator(options->wished()); }});
  command->add_option("--tool", options->wish.camera, "the camera, where there are several");
  command->add_option("--board", options->board, "what it saw")
      ->check(CLI::IsMember({"chessboard", "charuco"}));
  command->add_option("--columns", board.columns, "inner corners of a chessboard, squares of a ChArUco");
  command->add_option("--rows", board.rows, "likewise");
  command->add_option("--square-mm", options->square_mm, "the side of a square, as printed");
  command->add_option("--marker-mm", options->marker_mm,
                      "the side of a ChArUco's marker; 0: three quarters of a square");
  command->add_option("--dictionary", board.dictionary, "of a ChArUco's markers, as OpenCV names it");
}

}  // namespace fude
