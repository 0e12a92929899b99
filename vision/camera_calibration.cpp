#include "vision/camera_calibration.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <opencv2/calib3d.hpp>
#include <utility>

namespace fude {
namespace {

constexpr std::size_t fewest_views = 5;
constexpr int cells_across = 6;  // of the coverage map
constexpr int cells_down = 5;
constexpr double least_coverage = 0.5;
constexpr double least_tilt_rad = 15 * 3.14159265358979 / 180;
constexpr double most_focal_deviation = 0.01;  // of the focal length
constexpr double most_rms_px = 1;
// A corner this many times farther out than the typical one of all views, and more than this, is none of
// them: with normal errors one in ten thousand lies beyond.
constexpr double outlier_factor = 4.5;
constexpr double outlier_least_px = 0.75;
constexpr double most_outliers = 0.25;  // of a view's corners; with more the view is none

struct Corner {
  int number = 0;
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
};

// The corners of each view that still count.
using Views = std::vector<std::vector<Corner>>;

struct Fit {
  cv::Mat matrix, distortion, deviations;
  std::vector<cv::Mat> turns, places;
};

std::vector<cv::Point3f> places_of(const Board& board, const std::vector<Corner>& corners) {
  std::vector<cv::Point3f> places;
  for (const Corner& corner : corners) {
    const Eigen::Vector2f place = corner_place_m(board, corner.number).cast<float>();
    places.emplace_back(place.x(), place.y(), 0.F);
  }
  return places;
}

std::vector<cv::Point2f> pixels_of(const std::vector<Corner>& corners) {
  std::vector<cv::Point2f> pixels;
  for (const Corner& corner : corners)
    pixels.emplace_back(static_cast<float>(corner.pixel.x()), static_cast<float>(corner.pixel.y()));
  return pixels;
}

Fit fit(const Board& board, const Views& views, cv::Size size) {
  std::vector<std::vector<cv::Point3f>> places;
  std::vector<std::vector<cv::Point2f>> pixels;
  for (const auto& corners : views) {
    places.push_back(places_of(board, corners));
    pixels.push_back(pixels_of(corners));
  }
  Fit f;
  cv::Mat of_poses, of_views;
  cv::calibrateCamera(places, pixels, size, f.matrix, f.distortion, f.turns, f.places, f.deviations, of_poses,
                      of_views);
  return f;
}

std::vector<double> distances(const Fit& f, const cv::Mat& turn, const cv::Mat& place, const Board& board,
                              const std::vector<Corner>& corners) {
  std::vector<cv::Point2f> seen;
  cv::projectPoints(places_of(board, corners), turn, place, f.matrix, f.distortion, seen);
  std::vector<double> all;
  for (std::size_t i = 0; i < corners.size(); ++i)
    all.push_back((corners[i].pixel - Eigen::Vector2d(seen[i].x, seen[i].y)).norm());
  return all;
}

double rms(const std::vector<double>& values) {
  if (values.empty()) return 0;
  return std::sqrt(std::inner_product(values.begin(), values.end(), values.begin(), 0.0) /
                   static_cast<double>(values.size()));
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

Pose<Camera, BoardFrame> pose_of(const cv::Mat& turn, const cv::Mat& place) {
  const Eigen::Vector3d axis(turn.at<double>(0), turn.at<double>(1), turn.at<double>(2));
  const double angle = axis.norm();
  Pose<Camera, BoardFrame> pose;
  if (angle > 0) pose.rotation = Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis / angle));
  pose.translation = {place.at<double>(0), place.at<double>(1), place.at<double>(2)};
  return pose;
}

// Halves of the views in turn: a fit of the others, each view's pose found in it, its corners' distances.
double held_out_rms(const Board& board, const Views& views, cv::Size size) {
  std::vector<double> all;
  for (std::size_t half = 0; half < 2; ++half) {
    Views fitted;
    for (std::size_t i = 0; i < views.size(); ++i)
      if (i % 2 != half) fitted.push_back(views[i]);
    const Fit f = fit(board, fitted, size);
    for (std::size_t i = half; i < views.size(); i += 2) {
      cv::Mat turn, place;
      cv::solvePnP(places_of(board, views[i]), pixels_of(views[i]), f.matrix, f.distortion, turn, place);
      const auto here = distances(f, turn, place, board, views[i]);
      all.insert(all.end(), here.begin(), here.end());
    }
  }
  return rms(all);
}

std::string coverage_map(const Views& views, cv::Size size) {
  std::string cells(static_cast<std::size_t>(cells_across * cells_down), '.');
  const auto cell = [](double place, int length, int cells_there) {
    return std::clamp(static_cast<int>(place / length * cells_there), 0, cells_there - 1);
  };
  for (const auto& corners : views)
    for (const Corner& corner : corners)
      cells[static_cast<std::size_t>(cell(corner.pixel.y(), size.height, cells_down) * cells_across +
                                     cell(corner.pixel.x(), size.width, cells_across))] = '#';
  return cells;
}

double share_covered(const std::string& cells) {
  return static_cast<double>(std::ranges::count(cells, '#')) / static_cast<double>(cells.size());
}

std::string where_bare(const std::string& cells) {
  const auto bare = [&](int from_x, int to_x, int from_y, int to_y) {
    int n = 0;
    for (int y = from_y; y < to_y; ++y)
      for (int x = from_x; x < to_x; ++x) n += cells[static_cast<std::size_t>(y * cells_across + x)] == '.';
    return n;
  };
  const std::pair<int, const char*> sides[] = {
      {bare(0, cells_across / 2, 0, cells_down) * 2, "left"},
      {bare(cells_across / 2, cells_across, 0, cells_down) * 2, "right"},
      {bare(0, cells_across, 0, cells_down / 2) * cells_down / 2, "upper"},
      {bare(0, cells_across, cells_down - cells_down / 2, cells_down) * cells_down / 2, "lower"}};
  return std::max_element(std::begin(sides), std::end(sides))->second;
}

double largest_tilt(const std::vector<FittedView>& views) {
  double largest = 0;
  for (const FittedView& a : views)
    for (const FittedView& b : views) {
      if (!a.used || !b.used) continue;
      const double cosine = (a.camera_from_board.rotation * Eigen::Vector3d::UnitZ())
                                .dot(b.camera_from_board.rotation * Eigen::Vector3d::UnitZ());
      largest = std::max(largest, std::acos(std::clamp(cosine, -1.0, 1.0)));
    }
  return largest;
}

std::string formatted(const char* format, double value) {
  char text[200];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

}  // namespace

Result<CameraProcedure> CameraProcedure::begin(const Board& board) {
  if (auto sound = check(board); !sound) return tl::unexpected(sound.error());
  return CameraProcedure(board);
}

CameraProcedure::Progress CameraProcedure::add(const GreyImage& image, const std::string& name) {
  if (views_.kept().empty() && boardless_.empty()) {
    width_ = image.width;
    height_ = image.height;
  }
  std::optional<BoardView> view;
  if (image.width == width_ && image.height == height_) view = find_board(image, board_);
  if (!view) {
    boardless_.push_back(name);
  } else {
    view->name = name;
    goes_on_ += view->goes_on;
    views_.add(std::move(*view));
  }
  Progress progress;
  progress.views = views_.kept().size();
  Views all;
  for (const BoardView& v : views_.kept()) {
    all.emplace_back();
    for (const Eigen::Vector2d& pixel : v.pixels) all.back().push_back({0, pixel});
  }
  const std::string cells = coverage_map(all, {std::max(width_, 1), std::max(height_, 1)});
  const double of_views = std::min(1.0, static_cast<double>(views_.kept().size()) / fewest_views);
  progress.covered = std::min(of_views, std::min(1.0, share_covered(cells) / least_coverage));
  if (of_views < 1)
    progress.missing = "more pictures of the board, each with another tilt";
  else if (progress.covered < 1)
    progress.missing = "the board in the " + where_bare(cells) + " part of the picture";
  return progress;
}

CameraCalibration CameraProcedure::finish() const {
  CameraCalibration result;
  result.boardless = boardless_;
  result.alike = views_.passed_over();
  const auto refused = [&result](std::string reason) {
    result.reason = std::move(reason);
    return result;
  };
  if (views_.kept().size() < fewest_views)
    return refused("the board was found in " + std::to_string(views_.kept().size()) + " of " +
                   std::to_string(views_.kept().size() + boardless_.size()) + " pictures, " +
                   std::to_string(fewest_views) +
                   " are needed; give --columns and --rows as printed, and show the whole board");
  const cv::Size size(width_, height_);
  Views counted;
  for (const BoardView& view : views_.kept()) {
    counted.emplace_back();
    for (std::size_t i = 0; i < view.corners.size(); ++i)
      counted.back().push_back({view.corners[i], view.pixels[i]});
    FittedView& fitted = result.views.emplace_back();
    fitted.name = view.name;
    fitted.corners = view.corners.size();
  }
  std::vector<std::size_t> used(counted.size());  // views, by number
  std::iota(used.begin(), used.end(), std::size_t{0});

  Fit f;
  try {
    // The farthest outliers first: what is far out draws the fit, and its neighbours with it.
    for (;;) {
      Views views;
      for (const std::size_t i : used) views.push_back(counted[i]);
      f = fit(board_, views, size);
      std::vector<std::vector<double>> away;
      std::vector<double> all;
      for (std::size_t v = 0; v < used.size(); ++v) {
        away.push_back(distances(f, f.turns[v], f.places[v], board_, views[v]));
        all.insert(all.end(), away.back().begin(), away.back().end());
      }
      const double limit = std::max(outlier_factor * median(all), outlier_least_px);
      std::size_t worst = used.size();
      double worst_rms = 0;
      for (std::size_t v = 0; v < used.size(); ++v) {
        const bool outlying = std::ranges::any_of(away[v], [&](double d) { return d > limit; });
        if (outlying && rms(away[v]) > worst_rms) {
          worst = v;
          worst_rms = rms(away[v]);
        }
      }
      if (worst == used.size()) {
        result.residuals_px = all;
        for (std::size_t v = 0; v < used.size(); ++v) {
          result.views[used[v]].rms_px = rms(away[v]);
          result.views[used[v]].camera_from_board = pose_of(f.turns[v], f.places[v]);
        }
        break;
      }
      FittedView& view = result.views[used[worst]];
      std::vector<Corner>& corners = counted[used[worst]];
      const double largest = std::ranges::max(away[worst]);
      for (std::size_t i = corners.size(); i-- > 0;)
        if (away[worst][i] > std::max(limit, largest / 2)) {
          view.outliers.push_back(corners[i].number);
          corners.erase(corners.begin() + static_cast<std::ptrdiff_t>(i));
        }
      if (static_cast<double>(view.outliers.size()) > most_outliers * static_cast<double>(view.corners)) {
        view.used = false;
        view.rms_px = worst_rms;
        used.erase(used.begin() + static_cast<std::ptrdiff_t>(worst));
      }
      if (used.size() < fewest_views)
        return refused("only " + std::to_string(used.size()) +
                       " views agree with each other; is the board flat, and are --columns, --rows and "
                       "--square-mm as printed?");
    }
    Views views;
    for (const std::size_t i : used) views.push_back(counted[i]);
    result.held_out_rms_px = held_out_rms(board_, views, size);
    result.coverage_map = coverage_map(views, size);
  } catch (const cv::Exception& trouble) {
    return refused("the pictures do not determine a camera (" + std::string(trouble.err) +
                   "); take them anew with the board tilted in many ways");
  }

  result.camera.width = width_;
  result.camera.height = height_;
  result.camera.focal_px = {f.matrix.at<double>(0, 0), f.matrix.at<double>(1, 1)};
  result.camera.centre_px = {f.matrix.at<double>(0, 2), f.matrix.at<double>(1, 2)};
  for (std::size_t i = 0; i < result.camera.distortion.size(); ++i)
    result.camera.distortion[i] = f.distortion.at<double>(static_cast<int>(i));
  result.focal_deviation_px = {f.deviations.at<double>(0), f.deviations.at<double>(1)};
  result.centre_deviation_px = {f.deviations.at<double>(2), f.deviations.at<double>(3)};
  result.coverage = share_covered(result.coverage_map);
  result.tilt_rad = largest_tilt(result.views);
  if (2 * goes_on_ > views_.kept().size() + views_.passed_over())
    result.warnings.push_back("the board goes on beyond the " + std::to_string(board_.columns) + " x " +
                              std::to_string(board_.rows) +
                              " inner corners that were named: count them again");
  for (const FittedView& view : result.views) {
    if (!view.used)
      result.warnings.push_back(view.name + " is left out: its corners stand " +
                                formatted("%.2f px", view.rms_px) + " from where the other views put them");
    else if (!view.outliers.empty())
      result.warnings.push_back(view.name + ": " + std::to_string(view.outliers.size()) +
                                " corners are left out, too far from where the other views put them");
  }

  const double surest = (result.focal_deviation_px.array() / result.camera.focal_px.array()).maxCoeff();
  if (result.coverage < least_coverage)
    return refused(formatted("the board was seen in %.0f %% of the picture only; show it in the ",
                             100 * result.coverage) +
                   where_bare(result.coverage_map) + " part as well");
  if (result.tilt_rad < least_tilt_rad)
    return refused(
        "the board was held almost the same way in every picture; tilt it to all sides, by 30 "
        "degrees or so");
  if (!(surest <= most_focal_deviation))
    return refused(
        formatted("the focal length is known to %.1f %% only; tilt the board more, and fill more "
                  "of the picture with it",
                  100 * surest));
  if (rms(result.residuals_px) > most_rms_px)
    return refused(
        formatted("the corners stand %.2f px from where a camera would see them; is the board "
                  "flat, the picture sharp and still?",
                  rms(result.residuals_px)));
  result.accepted = true;
  result.reason = result.warnings.empty() ? "good" : "good, with warnings";
  return result;
}

}  // namespace fude
