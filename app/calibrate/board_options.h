// --board and what belongs to it.
#pragma once

#include <string>

#include "vision/board.h"

namespace CLI {
class App;
}

namespace fude {

struct BoardOptions {
  std::string kind = "chessboard";
  int columns = 9;
  int rows = 6;
  double square_mm = 25;
  double marker_mm = 0;  // 0: three quarters of a square
  std::string dictionary = Board{}.dictionary;

  Board board() const;
};

void add_board_options(CLI::App& command, BoardOptions& options);

}  // namespace fude
