// The page that is printed for `fude calibrate camera`: a board, how large it is, and a ruler to check it by.
#pragma once

#include <string>

#include "rig/calibration/printed_page.h"
#include "signal/result.h"
#include "vision/board.h"

namespace fude {

// "a4", "a3" or "letter", upright or lying as the board fits. 8 mm stay free all around, and below the board
// there is a ruler of 100 mm and a line of text. Errors: usage for a board that cannot be, a page that is not
// known, and a board that does not fit, saying how large its squares may be.
Result<PrintedPage> printed_target(const Board& board, const std::string& page);

}  // namespace fude
