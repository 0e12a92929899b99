#include "app/calibrate/board_options.h"

#include <CLI/CLI.hpp>

namespace fude {

Board BoardOptions::board() const {
  return {.kind = kind == "charuco" ? BoardKind::charuco : BoardKind::chessboard,
          .columns = columns,
          .rows = rows,
          .square_m = 1e-3 * square_mm,
          .marker_m = 1e-3 * (marker_mm > 0 ? marker_mm : 0.75 * square_mm),
          .dictionary = dictionary};
}

void add_board_options(CLI::App& command, BoardOptions& options) {
  command.add_option("--board", options.kind, "what kind")->check(CLI::IsMember({"chessboard", "charuco"}));
  command.add_option("--columns", options.columns, "inner corners of a chessboard, squares of a ChArUco");
  command.add_option("--rows", options.rows, "likewise");
  command.add_option("--square-mm", options.square_mm, "the side of a square, as printed");
  command.add_option("--marker-mm", options.marker_mm,
                     "the side of a ChArUco's marker; 0: three quarters of a square");
  command.add_option("--dictionary", options.dictionary, "of a ChArUco's markers, as OpenCV names it");
}

}  // namespace fude
