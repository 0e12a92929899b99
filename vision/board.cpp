#include "vision/board.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <opencv2/aruco/charuco.hpp>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "vision/board_dictionary.h"

namespace fude {
namespace {

struct NamedDictionary {
  const char* name;
  cv::aruco::PREDEFINED_DICTIONARY_NAME number;
};
constexpr std::array dictionaries{
    NamedDictionary{"DICT_4X4_50", cv::aruco::DICT_4X4_50},
    NamedDictionary{"DICT_4X4_100", cv::aruco::DICT_4X4_100},
    NamedDictionary{"DICT_4X4_250", cv::aruco::DICT_4X4_250},
    NamedDictionary{"DICT_4X4_1000", cv::aruco::DICT_4X4_1000},
    NamedDictionary{"DICT_5X5_50", cv::aruco::DICT_5X5_50},
    NamedDictionary{"DICT_5X5_100", cv::aruco::DICT_5X5_100},
    NamedDictionary{"DICT_5X5_250", cv::aruco::DICT_5X5_250},
    NamedDictionary{"DICT_5X5_1000", cv::aruco::DICT_5X5_1000},
    NamedDictionary{"DICT_6X6_50", cv::aruco::DICT_6X6_50},
    NamedDictionary{"DICT_6X6_100", cv::aruco::DICT_6X6_100},
    NamedDictionary{"DICT_6X6_250", cv::aruco::DICT_6X6_250},
    NamedDictionary{"DICT_6X6_1000", cv::aruco::DICT_6X6_1000},
};

constexpr int fewest_corners = 6;  // a pose has six numbers; with four there is nothing to judge it by
constexpr int most_corners = 100;  // a side
// A corner's place is sought in a window of half this size, in shares of the way to the nearest other corner:
// farther out stand the edges of other squares.
constexpr double window_share = 0.25;

const NamedDictionary* find_dictionary(const std::string& name) {
  const auto* found = std::find_if(dictionaries.begin(), dictionaries.end(),
                                   [&](const NamedDictionary& d) { return name == d.name; });
  return found == dictionaries.end() ? nullptr : found;
}

cv::Mat seen(const GreyImage& image) {
  return {image.height, image.width, CV_8U, const_cast<std::uint8_t*>(image.pixels.data())};
}

double nearest_neighbours_px(const std::vector<cv::Point2f>& corners) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < corners.size(); ++i)
    for (std::size_t j = i + 1; j < corners.size(); ++j)
      least = std::min(least, cv::norm(corners[i] - corners[j]));
  return least;
}

void refine(const cv::Mat& picture, std::vector<cv::Point2f>& corners) {
  const double reach = window_share * nearest_neighbours_px(corners);
  if (!(reach >= 2)) return;
  constexpr int steps = 100;
  constexpr double step_px = 1e-4;
  const int half = static_cast<int>(reach);
  cv::cornerSubPix(picture, corners, {half, half}, {-1, -1},
                   cv::TermCriteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, steps, step_px));
}

bool on_one_line(const Board& board, const std::vector<int>& corners) {
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const int a : corners) {
    const Eigen::Vector2d way = corner_place_m(board, a) - corner_place_m(board, corners.front());
    scatter += way * way.transpose() / (board.square_m * board.square_m);
  }
  return scatter.determinant() < 0.5;  // a single corner beside the line gives 1
}

std::vector<cv::Point2f> chessboard_corners(const cv::Mat& picture, const Board& board) {
  std::vector<cv::Point2f> corners;
  constexpr int how = cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE;
  if (!cv::findChessboardCorners(picture, {board.columns, board.rows}, corners, how)) corners.clear();
  return corners;
}

// Mean grey about a place; none at the edge of the picture or beyond it.
std::optional<double> grey_at(const cv::Mat& picture, const cv::Point2d& place) {
  const int x = static_cast<int>(std::lround(place.x)), y = static_cast<int>(std::lround(place.y));
  if (x < 1 || y < 1 || x + 1 >= picture.cols || y + 1 >= picture.rows) return std::nullopt;
  return cv::mean(picture(cv::Rect(x - 1, y - 1, 3, 3)))[0];
}

// The corners of a chessboard as a grid, and where squares of it and beyond it have their middles.
class CornerGrid {
 public:
  CornerGrid(const std::vector<cv::Point2f>& corners, int columns, int rows)
      : corners_(corners), columns_(columns), rows_(rows) {}

  // Of the square between corners (x, y) and (x + 1, y + 1). Beyond the corners, by up to two squares, a row
  // goes on as a parabola through its last three: a lens bends it.
  cv::Point2d middle(int x, int y) const {
    const auto at_row = [&](int row) { return along(x + 0.5, columns_, [&](int i) { return at(i, row); }); };
    return along(y + 0.5, rows_, at_row);
  }

 private:
  cv::Point2d at(int x, int y) const { return corners_[static_cast<std::size_t>(y * columns_ + x)]; }

  template <class Place>
  static cv::Point2d along(double where, int count, Place place) {
    const int middle = std::clamp(static_cast<int>(std::lround(where)), 1, count - 2);
    const double s = where - middle;
    return place(middle - 1) * (s * (s - 1) / 2) + place(middle) * (1 - s * s) +
           place(middle + 1) * (s * (s + 1) / 2);
  }

  const std::vector<cv::Point2f>& corners_;
  int columns_, rows_;
};

// Squares of a part of the grid: the square between corners (0, 0) and (1, 1) is even.
struct Square {
  bool odd = false;
  double grey = 0;
};
std::vector<Square> squares_of(const cv::Mat& picture, const CornerGrid& grid, int first_x, int last_x,
                               int first_y, int last_y) {
  std::vector<Square> squares;
  for (int y = first_y; y <= last_y; ++y)
    for (int x = first_x; x <= last_x; ++x)
      if (const auto grey = grey_at(picture, grid.middle(x, y)))
        squares.push_back({std::abs(x + y) % 2 == 1, *grey});
  return squares;
}

// Mean greys of the even and of the odd ones.
struct Shades {
  double even = 0, odd = 0;
  double middle() const { return (even + odd) / 2; }
  bool odd_are_brighter() const { return odd > even; }
};
Shades shades_of(const std::vector<Square>& squares) {
  double sum[2] = {}, count[2] = {};
  for (const Square& square : squares) {
    sum[square.odd] += square.grey;
    ++count[square.odd];
  }
  return {sum[0] / std::max(1.0, count[0]), sum[1] / std::max(1.0, count[1])};
}

// Squares beyond the outermost that were named, where a board has its rim. A table may look like some of
// them, hardly like all.
bool board_goes_on(const cv::Mat& picture, const CornerGrid& grid, const Board& board, const Shades& inside) {
  const int right = board.columns, below = board.rows;
  const std::vector<Square> beyond[] = {
      squares_of(picture, grid, -2, -2, 0, below - 2), squares_of(picture, grid, right, right, 0, below - 2),
      squares_of(picture, grid, 0, right - 2, -2, -2), squares_of(picture, grid, 0, right - 2, below, below)};
  return std::ranges::any_of(beyond, [&](const std::vector<Square>& side) {
    const auto continued = std::ranges::count_if(side, [&](const Square& square) {
      const bool bright = square.grey > inside.middle();
      return bright == (square.odd == inside.odd_are_brighter());
    });
    const auto seen = static_cast<std::ptrdiff_t>(side.size());
    return seen >= 3 && continued >= seen - seen / 6;
  });
}

// Noise of a sensor and of its packing, and the two fields of a television's picture, turn small markers into
// others. A little less sharp, ten recorded frames of 720 x 576 gave 611 corners, of which 4 were wrong,
// instead of 451 and 37, and 0.57 instead of 0.67 px.
cv::Mat smoothed(const cv::Mat& picture) {
  constexpr double sigma_px = 0.8;
  cv::Mat smooth;
  cv::GaussianBlur(picture, smooth, {}, sigma_px);
  return smooth;
}

std::vector<cv::Point2f> charuco_corners(const cv::Mat& picture, const Board& board,
                                         std::vector<int>& numbers) {
  const auto charuco = charuco_board(board);
  std::vector<std::vector<cv::Point2f>> markers;
  std::vector<int> ids;
  cv::aruco::detectMarkers(picture, charuco->dictionary, markers, ids);
  std::vector<cv::Point2f> corners;
  if (!ids.empty()) cv::aruco::interpolateCornersCharuco(markers, ids, picture, charuco, corners, numbers);
  return corners;
}

}  // namespace

cv::Ptr<cv::aruco::CharucoBoard> charuco_board(const Board& board) {
  return cv::aruco::CharucoBoard::create(
      board.columns, board.rows, static_cast<float>(board.square_m), static_cast<float>(board.marker_m),
      cv::aruco::getPredefinedDictionary(find_dictionary(board.dictionary)->number));
}

int marker_modules(const Board& board) {
  return cv::aruco::getPredefinedDictionary(find_dictionary(board.dictionary)->number)->markerSize + 2;
}

Result<void> check(const Board& board) {
  const int least = board.kind == BoardKind::chessboard ? 3 : 2;
  if (board.columns < least || board.rows < least || board.columns > most_corners ||
      board.rows > most_corners)
    return failure(Fault::usage, "a board has " + std::to_string(least) + " to " +
                                     std::to_string(most_corners) + " columns and rows");
  if (!(board.square_m > 0) || !(board.square_m < 1))
    return failure(Fault::usage, "a board's squares have a side between 0 and 1000 mm");
  if (board.kind == BoardKind::chessboard) return {};
  if (!(board.marker_m > 0) || !(board.marker_m < board.square_m))
    return failure(Fault::usage, "a ChArUco's markers are smaller than its squares");
  if (const NamedDictionary* found = find_dictionary(board.dictionary)) {
    const int markers = board.columns * board.rows / 2;
    const int there = cv::aruco::getPredefinedDictionary(found->number)->bytesList.rows;
    if (markers <= there) return {};
    return failure(Fault::usage, board.dictionary + " has " + std::to_string(there) + " markers, the board " +
                                     std::to_string(markers));
  }
  std::string names;
  for (const NamedDictionary& d : dictionaries) names += std::string(names.empty() ? "" : ", ") + d.name;
  return failure(Fault::usage, "'" + board.dictionary + "' is no dictionary; take one of " + names);
}

int corners_of(const Board& board) {
  return board.kind == BoardKind::chessboard ? board.columns * board.rows
                                             : (board.columns - 1) * (board.rows - 1);
}

bool has_one_way_up(const Board& board) {
  return board.kind == BoardKind::charuco || (board.columns + board.rows) % 2 == 1;
}

Eigen::Vector2d corner_place_m(const Board& board, int number) {
  const int across = board.kind == BoardKind::chessboard ? board.columns : board.columns - 1;
  return board.square_m * Eigen::Vector2d(number % across, number / across);
}

std::optional<BoardView> find_board(const GreyImage& image, const Board& board) {
  if (image.width < 16 || image.height < 16) return std::nullopt;
  const bool charuco = board.kind == BoardKind::charuco;
  BoardView view;
  std::vector<cv::Point2f> corners;
  try {
    const cv::Mat picture = charuco ? smoothed(seen(image)) : seen(image);
    if (!charuco) {
      corners = chessboard_corners(picture, board);
      for (int i = 0; i < static_cast<int>(corners.size()); ++i) view.corners.push_back(i);
    } else {
      corners = charuco_corners(picture, board, view.corners);
    }
    if (static_cast<int>(corners.size()) < fewest_corners || on_one_line(board, view.corners))
      return std::nullopt;
    refine(picture, corners);
    if (!charuco) {
      const CornerGrid grid(corners, board.columns, board.rows);
      const Shades inside = shades_of(squares_of(picture, grid, 0, board.columns - 2, 0, board.rows - 2));
      view.goes_on = board_goes_on(picture, grid, board, inside);
      if (has_one_way_up(board) && !inside.odd_are_brighter()) std::ranges::reverse(corners);
    }
  } catch (const cv::Exception&) {
    return std::nullopt;  // OpenCV's own checks of what a hostile picture showed
  }
  for (const cv::Point2f& corner : corners) view.pixels.emplace_back(corner.x, corner.y);
  return view;
}

}  // namespace fude
