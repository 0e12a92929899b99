#include "vision/camera_pose.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <opencv2/calib3d.hpp>
#include <utility>

namespace fude {
namespace {

constexpr double mm_per_m = 1e3;
constexpr double most_rms_px = 1, fair_rms_px = 0.5;
constexpr double most_radius_mm = 2;
constexpr double moved_px = 1.5;        // of a picture's corners from where most pictures have them
constexpr double outlier_factor = 4.5;  // as of a camera's views
constexpr double outlier_least_px = 0.75;
constexpr double most_outliers = 0.25;   // of the corners
constexpr double other_way = 1.5;        // times larger residuals that the second of two poses must leave, if
constexpr double other_turn_rad = 0.03;  // it is another one
constexpr double small_share = 0.08;     // of the picture

using Vector6 = Eigen::Matrix<double, 6, 1>;

struct Corner {
  int number = 0;
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
};
using Corners = std::vector<Corner>;

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double rms(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v * v;
  return values.empty() ? 0 : std::sqrt(sum / static_cast<double>(values.size()));
}

std::string in_words(double value, int decimals = 2) {
  char text[48];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  return text;
}

// Each corner where most views have it, coordinate by coordinate.
Corners middle_of(const std::vector<const BoardView*>& views) {
  std::map<int, std::pair<std::vector<double>, std::vector<double>>> seen;
  for (const BoardView* view : views)
    for (std::size_t i = 0; i < view->corners.size(); ++i) {
      auto& [x, y] = seen[view->corners[i]];
      x.push_back(view->pixels[i].x());
      y.push_back(view->pixels[i].y());
    }
  Corners corners;
  for (auto& [number, places] : seen)
    corners.push_back({number, {median(places.first), median(places.second)}});
  return corners;
}

double away_px(const BoardView& view, const Corners& corners) {
  std::vector<double> lengths;
  for (std::size_t i = 0; i < view.corners.size(); ++i)
    for (const Corner& corner : corners)
      if (corner.number == view.corners[i]) lengths.push_back((corner.pixel - view.pixels[i]).norm());
  return rms(lengths);
}

struct Fit {
  cv::Vec3d turn, place;  // camera from board
  std::vector<Eigen::Vector2d> residuals_px;
  double rms_px = 0;
};

class Lens {
 public:
  Lens(const CameraModel& camera, const Board& board)
      : board_(board),
        matrix_(camera.focal_px.x(), 0, camera.centre_px.x(), 0, camera.focal_px.y(), camera.centre_px.y(), 0,
                0, 1),
        distortion_(camera.distortion.begin(), camera.distortion.end()) {}

  // Both poses that a flat board may have in a picture (Collins and Bartoli 2014), the better first.
  std::vector<Fit> fits(const Corners& corners) const {
    const auto places = places_of(corners);
    const auto pixels = pixels_of(corners);
    std::vector<cv::Mat> turns, shifts;
    cv::solvePnPGeneric(places, pixels, matrix_, distortion_, turns, shifts, false, cv::SOLVEPNP_IPPE);
    std::vector<Fit> both;
    for (std::size_t i = 0; i < turns.size(); ++i) {
      cv::Mat turn = turns[i], shift = shifts[i];
      cv::solvePnPRefineLM(places, pixels, matrix_, distortion_, turn, shift);
      both.push_back(judged(corners, cv::Vec3d(turn), cv::Vec3d(shift)));
    }
    std::ranges::sort(both, {}, &Fit::rms_px);
    return both;
  }

  Fit judged(const Corners& corners, const cv::Vec3d& turn, const cv::Vec3d& place) const {
    Fit fit{turn, place, {}, 0};
    std::vector<cv::Point2d> seen;
    cv::projectPoints(places_of(corners), turn, place, matrix_, distortion_, seen);
    std::vector<double> lengths;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      fit.residuals_px.push_back(corners[i].pixel - Eigen::Vector2d(seen[i].x, seen[i].y));
      lengths.push_back(fit.residuals_px.back().norm());
    }
    fit.rms_px = rms(lengths);
    return fit;
  }

  // Of the pixels by turn and place, two rows a corner.
  Eigen::MatrixXd jacobian(const Corners& corners, const Fit& fit) const {
    std::vector<cv::Point2d> seen;
    cv::Mat all;
    cv::projectPoints(places_of(corners), fit.turn, fit.place, matrix_, distortion_, seen, all);
    Eigen::MatrixXd j(all.rows, 6);
    for (int row = 0; row < all.rows; ++row)
      for (int column = 0; column < 6; ++column) j(row, column) = all.at<double>(row, column);
    return j;
  }

 private:
  std::vector<cv::Point3d> places_of(const Corners& corners) const {
    std::vector<cv::Point3d> places;
    for (const Corner& corner : corners) {
      const Eigen::Vector2d at = corner_place_m(board_, corner.number);
      places.emplace_back(at.x(), at.y(), 0);
    }
    return places;
  }
  static std::vector<cv::Point2d> pixels_of(const Corners& corners) {
    std::vector<cv::Point2d> pixels;
    for (const Corner& corner : corners) pixels.emplace_back(corner.pixel.x(), corner.pixel.y());
    return pixels;
  }

  Board board_;
  cv::Matx33d matrix_;
  std::vector<double> distortion_;
};

Pose<Camera, BoardFrame> pose_of(const Fit& fit) {
  const Eigen::Vector3d axis(fit.turn[0], fit.turn[1], fit.turn[2]);
  const double angle = axis.norm();
  Pose<Camera, BoardFrame> pose;
  if (angle > 0) pose.rotation = Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis / angle));
  pose.translation = {fit.place[0], fit.place[1], fit.place[2]};
  return pose;
}

bool differ(const Fit& a, const Fit& b) {
  return pose_of(a).rotation.angularDistance(pose_of(b).rotation) > other_turn_rad;
}

// How the camera's centre, in the board's frame, moves with the six numbers of the fit.
Eigen::Matrix<double, 3, 6> centre_by_pose(const Fit& fit) {
  constexpr double step = 1e-6;
  Eigen::Matrix<double, 3, 6> rows;
  for (int i = 0; i < 6; ++i) {
    Fit more = fit, less = fit;
    (i < 3 ? more.turn[i] : more.place[i - 3]) += step;
    (i < 3 ? less.turn[i] : less.place[i - 3]) -= step;
    rows.col(i) = (pose_of(more).inverse().translation - pose_of(less).inverse().translation) / (2 * step);
  }
  return rows;
}

// Millimetres of the board that one pixel is at a corner.
Eigen::Matrix2d mm_per_px(const CameraModel& camera, const Pose<Camera, BoardFrame>& pose,
                          const Eigen::Vector2d& at) {
  constexpr double step_m = 1e-4;
  Eigen::Matrix2d px_per_m;
  for (int axis = 0; axis < 2; ++axis) {
    Eigen::Vector3d step = Eigen::Vector3d::Zero();
    step(axis) = step_m;
    const Eigen::Vector3d place(at.x(), at.y(), 0);
    px_per_m.col(axis) =
        (camera.pixel_of(pose * (place + step)) - camera.pixel_of(pose * (place - step))) / (2 * step_m);
  }
  return mm_per_m * px_per_m.inverse();
}

double largest(const Eigen::MatrixXd& covariance) {
  return std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(covariance).eigenvalues().maxCoeff());
}

// Corners that stand away from the others are left out, the farthest first.
std::vector<Fit> fits_that_agree(const Lens& lens, Corners& corners) {
  const std::size_t all = corners.size();
  for (;;) {
    std::vector<Fit> both = lens.fits(corners);
    if (both.empty()) return both;
    std::vector<double> lengths;
    for (const Eigen::Vector2d& r : both.front().residuals_px) lengths.push_back(r.norm());
    const auto farthest = std::ranges::max_element(lengths);
    if (*farthest <= std::max(outlier_factor * median(lengths), outlier_least_px)) return both;
    if (static_cast<double>(all - corners.size() + 1) > most_outliers * static_cast<double>(all)) return both;
    corners.erase(corners.begin() + (farthest - lengths.begin()));
  }
}

double held_out_mm(const Lens& lens, const CameraModel& camera, const Board& board, const Corners& corners) {
  std::vector<double> lengths;
  for (std::size_t half = 0; half < 2; ++half) {
    Corners fitted, others;
    for (std::size_t i = 0; i < corners.size(); ++i) (i % 2 == half ? others : fitted).push_back(corners[i]);
    const std::vector<Fit> fits = lens.fits(fitted);
    if (fits.empty()) continue;
    const Fit judged = lens.judged(others, fits.front().turn, fits.front().place);
    const auto pose = pose_of(judged);
    for (std::size_t i = 0; i < others.size(); ++i)
      lengths.push_back(
          (mm_per_px(camera, pose, corner_place_m(board, others[i].number)) * judged.residuals_px[i]).norm());
  }
  return rms(lengths);
}

// Of the picture, within the corners' outline as a box.
double share_of(const Corners& corners, const CameraModel& camera) {
  Eigen::Vector2d low = corners.front().pixel, high = low;
  for (const Corner& corner : corners) {
    low = low.cwiseMin(corner.pixel);
    high = high.cwiseMax(corner.pixel);
  }
  return (high - low).prod() / (static_cast<double>(camera.width) * camera.height);
}

std::string size_in_words(std::int32_t width, std::int32_t height) {
  return std::to_string(width) + " x " + std::to_string(height);
}

}  // namespace

Pose<Paper, BoardFrame> lying_at(double x_m, double y_m, double turn_rad) {
  return {Eigen::Quaterniond(Eigen::AngleAxisd(turn_rad, Eigen::Vector3d::UnitZ())) *
              Eigen::Quaterniond(0, 1, 0, 0),
          {x_m, y_m, 0}};
}

Result<CameraPoseProcedure> CameraPoseProcedure::begin(const Board& board, const CameraModel& camera,
                                                       const Pose<Paper, BoardFrame>& paper_from_board) {
  if (auto sound = check(board); !sound) return tl::unexpected(sound.error());
  if (!has_one_way_up(board))
    return failure(Fault::usage,
                   "a chessboard of " + size_in_words(board.columns, board.rows) +
                       " inner corners looks the same upside down; lay down one with an odd and an "
                       "even number, or a ChArUco");
  return CameraPoseProcedure(board, camera, paper_from_board);
}

CameraPoseProcedure::Progress CameraPoseProcedure::add(const GreyImage& image, const std::string& name) {
  if (image.width != camera_.width || image.height != camera_.height) {
    other_size_ = size_in_words(image.width, image.height);
  } else if (auto view = find_board(image, board_)) {
    view->name = name;
    views_.push_back(std::move(*view));
  } else {
    boardless_.push_back(name);
  }
  return {views_.size(), views_.empty() ? "lay the whole board into the picture, flat on the paper" : ""};
}

CameraPlacement CameraPoseProcedure::finish() const {
  CameraPlacement result;
  result.boardless = boardless_;
  const auto refused = [&result](std::string reason) {
    result.reason = std::move(reason);
    return result;
  };
  if (views_.empty() && other_size_)
    return refused("the pictures are " + *other_size_ + ", the lens was calibrated with " +
                   size_in_words(camera_.width, camera_.height) + ": take them in the same way");
  if (views_.empty())
    return refused("the board was found in none of " + std::to_string(boardless_.size()) +
                   " pictures; give --columns and --rows as printed, and show the whole board");
  std::vector<const BoardView*> still;
  for (const BoardView& view : views_) still.push_back(&view);
  Corners corners = middle_of(still);
  std::erase_if(still, [&](const BoardView* view) {
    const bool elsewhere = away_px(*view, corners) > moved_px;
    if (elsewhere) result.moved.push_back(view->name);
    return elsewhere;
  });
  if (2 * still.size() <= views_.size())
    return refused("the camera or the board moved from picture to picture: let both rest");
  corners = middle_of(still);
  result.pictures = still.size();
  const std::size_t all_corners = corners.size();

  try {
    const Lens lens(camera_, board_);
    const std::vector<Fit> both = fits_that_agree(lens, corners);
    if (both.empty())
      return refused("the corners do not determine where the camera is; show more of the board");
    const Fit& fit = both.front();
    result.corners_left_out = all_corners - corners.size();
    const auto camera_from_board = pose_of(fit);
    result.paper_from_camera = paper_from_board_ * camera_from_board.inverse();
    result.rms_px = fit.rms_px;
    result.share_of_picture = share_of(corners, camera_);

    const Eigen::MatrixXd j = lens.jacobian(corners, fit);
    const Eigen::Matrix<double, 6, 6> information = j.transpose() * j;
    const Vector6 measure = information.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::VectorXd strengths = (measure.asDiagonal() * information * measure.asDiagonal())
                                          .selfadjointView<Eigen::Lower>()
                                          .eigenvalues();
    result.condition = std::sqrt(strengths.maxCoeff() / std::max(1e-300, strengths.minCoeff()));
    const double freedom = std::max(1.0, static_cast<double>(j.rows()) - 6);
    const double variance = fit.rms_px * fit.rms_px * static_cast<double>(corners.size()) / freedom;
    const Eigen::Matrix<double, 6, 6> covariance = variance * information.inverse();
    constexpr double chi_of_two = 2.448, chi_of_three = 2.795;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Eigen::Matrix2d scale =
          mm_per_px(camera_, camera_from_board, corner_place_m(board_, corners[i].number));
      result.residuals_mm.push_back((scale * fit.residuals_px[i]).norm());
      const Eigen::Matrix<double, 2, 6> of_pose = scale * j.middleRows<2>(static_cast<Eigen::Index>(2 * i));
      result.radius95_mm =
          std::max(result.radius95_mm, chi_of_two * largest(of_pose * covariance * of_pose.transpose()));
    }
    const auto of_centre = centre_by_pose(fit);
    result.camera_radius95_m = chi_of_three * largest(of_centre * covariance * of_centre.transpose());
    result.held_out_rms_mm = held_out_mm(lens, camera_, board_, corners);

    if (fit.rms_px > most_rms_px)
      return refused(
          "the corners stand " + in_words(fit.rms_px) +
          " px from where the lens would see them; is it this camera's, at this focus, and is the board "
          "flat?");
    if (both.size() > 1 && both[1].rms_px < other_way * fit.rms_px && differ(fit, both[1]))
      return refused(
          "two ways of standing explain the picture alike; look more from the side, or lay down a larger "
          "board");
    if (!(result.radius95_mm < most_radius_mm))
      return refused("places on the paper would be known to " + in_words(result.radius95_mm, 1) +
                     " mm only; lay down a larger board");
  } catch (const cv::Exception& trouble) {
    return refused("the picture does not determine where the camera is (" + std::string(trouble.err) +
                   "); take it anew");
  }
  for (const std::string& name : result.moved)
    result.warnings.push_back(name + " is left out: the camera or the board stood elsewhere");
  if (result.corners_left_out > 0)
    result.warnings.push_back(std::to_string(result.corners_left_out) +
                              " corners are left out, too far from where the others put them");
  if (std::ranges::count_if(still, &BoardView::goes_on) * 2 > static_cast<std::ptrdiff_t>(still.size()))
    result.warnings.push_back(
        "the board goes on beyond the " + size_in_words(board_.columns, board_.rows) +
        " inner corners that were named: count them again, or its first corner is another");
  if (result.rms_px > fair_rms_px)
    result.warnings.push_back(
        "the corners stand " + in_words(result.rms_px) +
        " px from where the lens would see them: is the board flat, and the lens's focus the "
        "same?");
  if (result.share_of_picture < small_share)
    result.warnings.push_back("the board fills " + in_words(100 * result.share_of_picture, 0) +
                              " % of the picture: far from it places are less sure; lay down a larger one");
  result.accepted = true;
  result.reason = "places on the paper under the board are known to within " + in_words(result.radius95_mm) +
                  " mm (95 %)";
  return result;
}

}  // namespace fude
