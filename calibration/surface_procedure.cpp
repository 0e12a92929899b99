#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "calibration/plane_fit.h"
#include "calibration/sheet_fit.h"
#include "calibration/surface.h"
#include "calibration/touch_coverage.h"

namespace fude {
namespace {

constexpr double mm_per_m = 1e3;
constexpr std::size_t fewest_places = 6;
constexpr std::size_t enough_places = 25, most_places = 60;  // for the progress
constexpr double apart_mm = 2;                               // places nearer than this are one
constexpr double worst_corner_mm = 5;
constexpr double finest_mm = 0.02;  // no touch is better than this
constexpr double worst_rms_mm = 2;
constexpr double fair_rms_mm = 0.6;
constexpr double narrowest_mm = 3;        // standard deviation across the longest extent
constexpr double narrowest_share = 0.05;  // of the longest extent
constexpr double most_touches_off = 0.2;
constexpr double worst_between_mm = 1.2;  // of a curved sheet, as error_between() has it
constexpr double fair_between_mm = 0.9;
constexpr double share_between = 0.5;  // of that, what the sheet is off between its touches
constexpr double most_wiped_off = 0.7;

using Points = std::vector<Eigen::Vector3d>;

std::size_t different_places(const std::vector<TipPoint>& touches) {
  Points places;
  for (const TipPoint& touch : touches) {
    const Eigen::Vector3d p = mm_per_m * touch.point_m;
    const auto near = [&](const Eigen::Vector3d& q) { return (p - q).norm() < apart_mm; };
    if (places.size() < enough_places && std::none_of(places.begin(), places.end(), near))
      places.push_back(p);
  }
  return places.size();
}

Points chosen(const Points& points, const std::vector<bool>& agrees) {
  Points some;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (agrees[i]) some.push_back(points[i]);
  return some;
}

// The frame whose z is `normal`, whose x lies nearest to `right`, about `origin`.
Pose<Paper, Tracker> frame(const Eigen::Vector3d& origin, const Eigen::Vector3d& normal,
                           const Eigen::Vector3d& right) {
  const Eigen::Vector3d x = (right - right.dot(normal) * normal).normalized();
  Eigen::Matrix3d axes;
  axes << x, normal.cross(x), normal;
  return Pose<Tracker, Paper>{Eigen::Quaterniond(axes), origin}.inverse();
}

struct Corners {
  Pose<Paper, Tracker> paper_from_tracker;
  Eigen::Vector2d size;
  double worst = 0;  // distance of a corner from the rectangle
  bool in_order = false;
};

Corners paper_of(const std::array<Eigen::Vector3d, 4>& c, const Eigen::Vector3d& normal,
                 const Eigen::Vector3d& on_plane) {
  std::array<Eigen::Vector3d, 4> flat;
  for (std::size_t i = 0; i < 4; ++i) flat[i] = c[i] - normal.dot(c[i] - on_plane) * normal;
  const Eigen::Vector3d middle = (flat[0] + flat[1] + flat[2] + flat[3]) / 4;
  const Eigen::Vector3d right = (flat[1] - flat[0] + flat[2] - flat[3]) / 2;
  const Eigen::Vector3d away = (flat[3] - flat[0] + flat[2] - flat[1]) / 2;
  Corners paper;
  const auto centred = frame(middle, normal, right);
  paper.size = {(centred.rotation * right).x(), (centred.rotation * away).y()};
  paper.in_order = paper.size.y() > 0;
  paper.paper_from_tracker = centred;
  paper.paper_from_tracker.translation += Eigen::Vector3d(paper.size.x() / 2, paper.size.y() / 2, 0);
  const Eigen::Vector2d ideal[] = {{0, 0}, {paper.size.x(), 0}, paper.size, {0, paper.size.y()}};
  for (std::size_t i = 0; i < 4; ++i)
    paper.worst = std::max(paper.worst, ((paper.paper_from_tracker * flat[i]).head<2>() - ideal[i]).norm());
  return paper;
}

// How well a curved sheet is known between its touches. A touch that is left out alone has neighbours on all
// sides; one that is left out with all its strip has none along it, and is foretold over twice the distance.
// The geometric mean of the two errors told the simulated sheets that were touched densely enough (off by 0.4
// mm at the most) from the others (0.7 mm and more).
struct Between {
  double error_mm = 0;
  double left_out_rms = 0;  // of lone touches
  std::string where;
};
Between error_between(const std::vector<Eigen::Vector3d>& on_sheet, double left_out_rms) {
  const std::vector<Strip> strips = left_out_strips(thinned(on_sheet));
  if (strips.empty()) return {};
  const Strip& worst = *std::ranges::max_element(strips, {}, &Strip::rms);
  return {std::sqrt(worst.rms * left_out_rms), left_out_rms,
          "about " + std::string(worst.axis == 0 ? "x" : "y") + " = " +
              in_words(worst.middle(worst.axis), 0) + " mm"};
}

std::string listed(const std::vector<std::string>& names) {
  std::string list;
  for (std::size_t i = 0; i < names.size(); ++i)
    list += (i == 0 ? "" : i + 1 < names.size() ? ", " : " and ") + names[i];
  return list;
}

// Touches that lie on one surface, plane or curved.
struct OneSurface {
  std::vector<bool> agrees;  // a point each
  bool curved = false;
  double left_out_rms = 0;  // of a curved one
};
OneSurface one_surface(const Points& points) {
  const RobustPlane plane = robust_plane(points, finest_mm);
  const auto raised = frame(plane.plane.centre, plane.plane.normal, plane.plane.along);
  Points over_plane;
  for (const Eigen::Vector3d& p : points) over_plane.push_back(raised * p);
  const auto sheet = fit_sheet(over_plane, finest_mm);
  if (sheet && sheet->better_than_plane) return {sheet->agrees, true, sheet->left_out_rms};
  return {plane.agrees};
}

// The paper as the rectangle about the touches, its z = 0 through them.
SurfaceCalibration about(const Points& used, const PlaneFit& flat, const Eigen::Vector3d& normal) {
  SurfaceCalibration surface;
  const Eigen::Vector3d right = flat.along.sum() < 0 ? -flat.along : flat.along;
  surface.paper_from_tracker = frame(flat.centre, normal, right);
  Eigen::Vector2d low = Eigen::Vector2d::Constant(1e9), high = -low;
  for (const Eigen::Vector3d& p : used) {
    const Eigen::Vector2d at = (surface.paper_from_tracker * p).head<2>();
    low = low.cwiseMin(at);
    high = high.cwiseMax(at);
  }
  surface.paper_from_tracker.translation -= Eigen::Vector3d(low.x(), low.y(), 0);
  surface.width_mm = high.x() - low.x();
  surface.height_mm = high.y() - low.y();
  return surface;
}

void judge(CalibrationReport& report, const SurfaceCalibration& surface, const Points& on_sheet,
           const Between& between) {
  const auto height = [&](const Eigen::Vector3d& p) {
    return surface.sheet ? surface.sheet->at(p.head<2>().transpose())(0) : 0;
  };
  std::vector<double> distances;
  double farthest = 0;
  for (const Eigen::Vector3d& p : on_sheet) {
    distances.push_back(std::abs(p.z() - height(p)));
    farthest = std::max(farthest, std::abs(height(p)));
  }
  summarise(report, distances, 1);
  const double freedom = surface.sheet ? surface.sheet->freedom() : 3;
  const double n = double(on_sheet.size()), spare = std::max(1.0, n - freedom);
  report.held_out_rms = surface.sheet ? between.left_out_rms : report.rms * n / spare;
  report.ci95 = {
      0, 1.96 * std::hypot(report.rms * std::sqrt(freedom / spare), share_between * between.error_mm)};
  report.detail("degrees_of_freedom", freedom);
  if (!surface.sheet) return;
  report.detail("farthest_from_plane_mm", farthest);
  report.detail("error_between_mm", between.error_mm);
}

// Of a sheet whose first four places are its corners.
std::vector<std::string> bare_parts(const std::vector<Eigen::Vector3d>& places_m) {
  const Eigen::Vector3d right_mm = mm_per_m * (places_m[1] - places_m[0]);
  const Eigen::Vector3d up_mm = mm_per_m * (places_m[3] - places_m[0]);
  Points points;
  for (const Eigen::Vector3d& place : places_m) {
    const Eigen::Vector3d at_mm = mm_per_m * (place - places_m[0]);
    points.emplace_back(at_mm.dot(right_mm.normalized()), at_mm.dot(up_mm.normalized()), 0);
  }
  return untouched_parts(points, right_mm.norm(), up_mm.norm());
}

}  // namespace

Progress SurfaceProcedure::add(const PoseSample& sample) {
  if (tool_.empty()) tool_ = sample.tool;
  const bool usable = screen_.look(sample) != PoseScreen::Finding::unusable;
  if (usable) {
    const Eigen::Vector3d tip = sample.tracker_from_tool * tip_m_;
    way_.push_back({sample.time.host, tip, screen_.seen() - 1});
    handle_side_ += sample.tracker_from_tool.translation - tip;
    const RestingTip rest;
    if ((tip - way_[rests_since_].point_m).norm() > 2 * rest.nearest_m) rests_since_ = way_.size() - 1;
    constexpr double far_m = 0.015;
    const auto near = [&](const Eigen::Vector3d& q) { return (tip - q).norm() < far_m; };
    if (sample.time.host - way_[rests_since_].time >= rest.shortest && places_.size() < most_places &&
        std::none_of(places_.begin(), places_.end(), near))
      places_.push_back(tip);
  }
  Progress progress{way_.size(), std::min(1.0, double(places_.size()) / double(enough_places)), missing()};
  constexpr double nearly = 0.99;
  if (!progress.missing.empty()) progress.covered = std::min(progress.covered, nearly);
  if (screen_.frozen()) progress.covered = 0;
  return progress;
}

// Enough places, and, where the corners say how large the sheet is, all over it.
std::string SurfaceProcedure::missing() const {
  if (places_.size() < enough_places)
    return "rest the tip on " + std::to_string(enough_places - places_.size()) + " more places";
  if (!corners_first_ || places_.size() == most_places) return {};
  const auto parts = bare_parts(places_);
  return parts.empty() ? std::string() : "rest the tip at the " + listed(parts) + " too";
}

Calibration<SurfaceCalibration> SurfaceProcedure::finish() const {
  CalibrationReport report;
  report.procedure = "surface";
  report.to_frame = "paper";
  report.from_frame = "tracker of tool " + tool_;
  screen_.warn(report);
  if (screen_.frozen())
    return refusal(report, "all poses are the same: the tracker is frozen, or the brush was never moved");
  std::vector<TipPoint> touches = resting_places(way_);
  const bool wiped = different_places(touches) < fewest_places;
  if (wiped) touches = way_;
  report.n = touches.size();
  report.detail("from", std::string(wiped ? "wiping" : "touches"));
  if (const std::size_t places = different_places(touches); places < fewest_places)
    return refusal(report, "only " + std::to_string(places) + " different places were touched, " +
                               std::to_string(fewest_places) + " are the fewest");

  Points points;
  for (const TipPoint& touch : touches) points.push_back(mm_per_m * touch.point_m);
  const OneSurface one = one_surface(points);
  const Points used = chosen(points, one.agrees);
  const PlaneFit flat = fit_plane(used);
  report.condition = flat.spread(0) / std::max(1e-9, flat.spread(1));
  if (flat.spread(1) < std::max(narrowest_mm, narrowest_share * flat.spread(0)))
    return refusal(report, "all touches lie on one line: touch all over the sheet");

  const Eigen::Vector3d normal = flat.normal.dot(handle_side_) < 0 ? -flat.normal : flat.normal;
  SurfaceCalibration surface = about(used, flat, normal);
  if (corners_first_ && !wiped) {
    const Corners paper = paper_of({points[0], points[1], points[2], points[3]}, normal, flat.centre);
    report.detail("corners_off_rectangle_mm", paper.worst);
    if (!paper.in_order)
      return refusal(report,
                     "the corners are out of order: touch lower left, lower right, upper right, upper left");
    if (paper.worst > worst_corner_mm)
      report.warnings.push_back("the corners are " + in_words(paper.worst, 1) + " mm off a rectangle");
    surface = {paper.paper_from_tracker, std::nullopt, paper.size.x(), paper.size.y()};
  } else {
    report.warnings.push_back(
        "the corners of the paper were not touched: it is the rectangle about the touches");
  }

  Points on_sheet;
  for (const Eigen::Vector3d& p : used) on_sheet.push_back(surface.paper_from_tracker * p);
  Between between;
  if (one.curved) {
    surface.sheet = sheet_through(thinned(on_sheet));
    between = error_between(on_sheet, one.left_out_rms);
  }
  judge(report, surface, on_sheet, between);

  std::vector<std::string> outliers;
  for (std::size_t i = 0; i < points.size() && !wiped; ++i)
    if (!one.agrees[i])
      outliers.push_back("touch " + std::to_string(i) + " at " +
                         in_words(seconds(touches[i].time.time_since_epoch()), 3) + " s, " +
                         in_words(std::abs(on_paper(surface, touches[i].point_m).z())) + " mm off");
  report.detail("outliers", outliers);
  const double off = 1 - double(used.size()) / double(points.size());
  report.detail("off_surface", off);
  if (off > (wiped ? most_wiped_off : most_touches_off))
    return refusal(
        report,
        in_words(100 * off, 0) + " in 100 " + (wiped ? "samples" : "touches") +
            " do not lie on one surface: did the tip touch it every time, and is it that tip? A wavy sheet "
            "wants eight touches a wave");
  if (report.rms > worst_rms_mm)
    return refusal(report,
                   "residual " + in_words(report.rms, 1) +
                       " mm: the surface gave way, the tip is not where the pivot says, or the sheet is "
                       "wavy and wants more touches, first " +
                       error_between(on_sheet, report.rms).where);
  if (between.error_mm > worst_between_mm)
    return refusal(report, "the sheet is wavier than its touches show, worst " + between.where +
                               ": touch more there, eight places a wave");
  if (between.error_mm > fair_between_mm)
    report.warnings.push_back("the sheet is known worst " + between.where +
                              ": more touches there would help");
  const auto parts = one.curved ? untouched_parts(thinned(on_sheet), surface.width_mm, surface.height_mm)
                                : std::vector<std::string>{};
  report.detail("untouched", parts);
  if (!parts.empty())
    report.warnings.push_back("the tip never was at the " + listed(parts) +
                              ": there the sheet is a guess that may be off by millimetres; touch there too");
  if (const auto spacing = grid_spacing(on_sheet); spacing && one.curved && !wiped)
    report.warnings.push_back("the touches stand in rows and columns, " + in_words(spacing->x(), 0) +
                              " and " + in_words(spacing->y(), 0) +
                              " mm apart: waves as short as that would look like long ones; if the sheet may "
                              "have them, touch between the rows too");
  if (!outliers.empty())
    report.warnings.push_back(std::to_string(outliers.size()) +
                              " touches are off the surface and were left out");
  if (report.rms > fair_rms_mm)
    report.warnings.push_back("residual " + in_words(report.rms) + " mm: press alike at every touch");
  report.accepted = true;
  report.reason = std::string(one.curved ? "a curved sheet" : "a plane") + " known to within " +
                  in_words((*report.ci95)[1]) + " mm (95 %)";
  return Calibrated<SurfaceCalibration>{surface, report};
}

}  // namespace fude
