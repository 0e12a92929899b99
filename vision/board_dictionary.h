// A ChArUco as OpenCV knows it; inside this room alone, where OpenCV's headers are.
#pragma once

#include <opencv2/aruco/charuco.hpp>

#include "vision/board.h"

namespace fude {

// `board` must have passed check().
cv::Ptr<cv::aruco::CharucoBoard> charuco_board(const Board& board);

// Along a side of its markers, the border's two included.
int marker_modules(const Board& board);

}  // namespace fude
