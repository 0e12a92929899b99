#include "calibration/rig_check.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>

#include "calibration/landmarks.h"

namespace fude {
namespace {

constexpr double mm_per_m = 1e3;
constexpr std::size_t fewest_touches = 3;

double degrees(double rad) { return rad * 180 / std::numbers::pi; }

double height_of(const SurfaceCalibration& surface, double x, double y) {
  return surface.sheet ? surface.sheet->at(Eigen::RowVector2d(x, y))(0) : 0;
}

std::array<Eigen::Vector3d, 4> corners_of(const SurfaceCalibration& surface) {
  const double w = surface.width_mm, h = surface.height_mm;
  const auto corner = [&](double x, double y) { return Eigen::Vector3d(x, y, height_of(surface, x, y)); };
  return {corner(0, 0), corner(w, 0), corner(w, h), corner(0, h)};
}

// Root of the mean square over the degrees of freedom that a fit of `fitted` numbers leaves, as a distance.
double scatter(const Points3& residuals, double fitted) {
  double squares = 0;
  for (const Eigen::Vector3d& r : residuals) squares += r.squaredNorm();
  return std::sqrt(3 * squares / (3 * double(residuals.size()) - fitted));
}

PaperMotion motion_of(const Similarity& now_from_then, const Eigen::Vector3d& middle) {
  const Eigen::Matrix3d& r = now_from_then.rotation;
  return {now_from_then(middle) - middle, std::atan2(r(1, 0) - r(0, 1), r(0, 0) + r(1, 1)),
          std::acos(std::clamp(r(2, 2), -1.0, 1.0))};
}

std::string in_mm(double value) { return in_words(value, 1) + " mm"; }

std::string words_of(const PaperMotion& paper) {
  const Eigen::Vector3d& s = paper.shift_mm;
  return in_mm(std::abs(s.x())) + (s.x() < 0 ? " to the left, " : " to the right, ") +
         in_mm(std::abs(s.y())) + (s.y() < 0 ? " down and " : " up and ") + in_mm(std::abs(s.z())) +
         (s.z() < 0 ? " below" : " above") + " where it was, turned by " +
         in_words(degrees(paper.turned_rad), 1) + " and tilted by " + in_words(degrees(paper.tilted_rad), 1) +
         " degrees";
}

std::string words_of(const Eigen::Vector3d& tip_mm) {
  return in_mm(tip_mm.norm()) + " (" + in_words(tip_mm.x(), 1) + ", " + in_words(tip_mm.y(), 1) + ", " +
         in_words(tip_mm.z(), 1) + ") in the frame of its markers";
}

const char* word_of(RigMoved moved) {
  switch (moved) {
    case RigMoved::nothing:
      return "nothing";
    case RigMoved::paper:
      return "paper";
    case RigMoved::tip:
      return "tip";
    case RigMoved::unclear:
      break;
  }
  return "unclear";
}

}  // namespace

Fields to_fields(const RigCheck& check) {
  Fields fields{{"moved", std::string(word_of(check.moved))}};
  if (check.paper) {
    const Eigen::Vector3d& s = check.paper->shift_mm;
    fields.push_back({"paper_right_mm", s.x()});
    fields.push_back({"paper_up_mm", s.y()});
    fields.push_back({"paper_off_mm", s.z()});
    fields.push_back({"paper_turned_deg", degrees(check.paper->turned_rad)});
    fields.push_back({"paper_tilted_deg", degrees(check.paper->tilted_rad)});
  }
  if (check.tip_shift_mm) {
    const Eigen::Vector3d& t = *check.tip_shift_mm;
    fields.push_back({"tip_moved_mm", std::vector{t.x(), t.y(), t.z()}});
  }
  return fields;
}

Progress RigCheckProcedure::add(const PoseSample& sample) {
  if (screen_.look(sample) != PoseScreen::Finding::unusable) {
    const Eigen::Vector3d tip = sample.tracker_from_tool * tip_m_;
    way_.push_back({sample.time.host, tip, way_.size()});
    turned_.push_back(sample.tracker_from_tool.rotation);
  }
  constexpr std::size_t between_looks = 64;
  if (rested_ < fewest_touches && way_.size() >= looked_ + between_looks) {
    looked_ = way_.size();
    rested_ = resting_places(way_).size();
  }
  const std::size_t left = fewest_touches - std::min(rested_, fewest_touches);
  return {way_.size(), 1 - double(left) / double(fewest_touches),
          left > 0 ? "rest the tip on " + std::to_string(left) +
                         " more of the paper's corners, leaning it differently"
                   : ""};
}

std::vector<RigCheckProcedure::Touch> RigCheckProcedure::touches() const {
  const auto corners = corners_of(surface_);
  std::vector<Touch> found;
  for (const TipPoint& rest : resting_places(way_)) {
    const Eigen::Vector3d at = surface_.paper_from_tracker * (mm_per_m * rest.point_m);
    const Eigen::Vector3d corner = *std::ranges::min_element(
        corners, {}, [&](const Eigen::Vector3d& c) { return (c - at).squaredNorm(); });
    found.push_back({at, corner, (surface_.paper_from_tracker.rotation * turned_[rest.number]).matrix()});
  }
  return found;
}

std::vector<RigCheckProcedure::Touch> RigCheckProcedure::corners_among(
    const std::vector<Touch>& touched) const {
  if (!corners_) return {};
  const double reach_mm = std::min(surface_.width_mm, surface_.height_mm) / 3;
  std::vector<Touch> near;
  std::ranges::copy_if(touched, std::back_inserter(near),
                       [&](const Touch& touch) { return (touch.at_mm - touch.corner_mm).norm() < reach_mm; });
  const auto different = std::ranges::count_if(corners_of(surface_), [&](const Eigen::Vector3d& corner) {
    return std::ranges::find(near, corner, &Touch::corner_mm) != near.end();
  });
  return different < 3 ? std::vector<Touch>{} : near;
}

Calibration<RigCheck> RigCheckProcedure::finish() const {
  CalibrationReport report;
  report.procedure = "check";
  report.to_frame = "paper";
  report.from_frame = "tool";
  report.ci95 = {0, limit_mm};
  screen_.warn(report);
  if (screen_.frozen())
    return refusal(report, "all poses are the same: the tracker is frozen, or the brush was never moved");
  const std::vector<Touch> touched = touches();
  if (touched.size() < fewest_touches)
    return refusal(report, "the tip rested at " + std::to_string(touched.size()) +
                               " places: rest it for a quarter of a second on three of the paper's corners");
  const std::vector<Touch> corners = corners_among(touched);
  return corners.empty() ? by_height(std::move(report), touched) : by_corners(std::move(report), corners);
}

Calibration<RigCheck> RigCheckProcedure::by_height(CalibrationReport report,
                                                   const std::vector<Touch>& touched) const {
  std::vector<double> heights;
  for (const Touch& touch : touched)
    heights.push_back(std::abs(touch.at_mm.z() - height_of(surface_, touch.at_mm.x(), touch.at_mm.y())));
  summarise(report, heights, 1);
  report.warnings.push_back(
      "three corners of the paper were not touched, or are not known: the height alone is checked");
  if (report.max > limit_mm) {
    report.detail("moved", std::string(word_of(RigMoved::unclear)));
    return refusal(report,
                   "the touches are up to " + in_mm(report.max) +
                       " off the surface: the paper or the tip has moved; touch three of its corners, "
                       "leaning the brush differently, to tell which");
  }
  report.accepted = true;
  report.reason = "the surface is where it was, to " + in_mm(report.max) + " in height";
  return Calibrated<RigCheck>{{}, report};
}

Calibration<RigCheck> RigCheckProcedure::by_corners(CalibrationReport report,
                                                    const std::vector<Touch>& touched) const {
  std::vector<double> off;
  Points3 now, then;
  Eigen::Vector3d tip_mm = Eigen::Vector3d::Zero();
  for (const Touch& touch : touched) {
    const Eigen::Vector3d offset = touch.at_mm - touch.corner_mm;
    now.push_back(touch.at_mm);
    then.push_back(touch.corner_mm);
    off.push_back(offset.norm());
    tip_mm -= touch.paper_turned.transpose() * offset / double(touched.size());
  }
  summarise(report, off, 3);
  const Similarity paper = register_points(then, now, Freedom::rigid);
  Points3 beside_paper, beside_tip;
  for (std::size_t i = 0; i < touched.size(); ++i) {
    beside_paper.push_back(now[i] - paper(then[i]));
    beside_tip.push_back(now[i] - then[i] + touched[i].paper_turned * tip_mm);
  }
  constexpr double rigid = 6, point = 3;
  const double paper_scatter = scatter(beside_paper, rigid), tip_scatter = scatter(beside_tip, point);
  const bool by_paper = paper_scatter <= limit_mm, by_tip = tip_scatter <= limit_mm;
  RigCheck check;
  check.paper = motion_of(paper, Eigen::Vector3d(surface_.width_mm / 2, surface_.height_mm / 2, 0));
  check.tip_shift_mm = tip_mm;
  if (report.max > limit_mm)
    check.moved = by_paper == by_tip ? RigMoved::unclear : by_paper ? RigMoved::paper : RigMoved::tip;
  for (Field& field : to_fields(check)) report.details.push_back(std::move(field));
  report.detail("paper_leaves_mm", paper_scatter);
  report.detail("tip_leaves_mm", tip_scatter);
  if (check.moved == RigMoved::nothing) {
    report.accepted = true;
    report.reason = "brush and paper are where they were, to " + in_mm(report.max);
    return Calibrated<RigCheck>{check, report};
  }
  if (check.moved == RigMoved::paper)
    return refusal(report, "the paper moved: it is " + words_of(*check.paper) + "; calibrate the surface");
  if (check.moved == RigMoved::tip)
    return refusal(report, "the tip moved by " + words_of(tip_mm) + "; calibrate the pivot");
  if (by_paper)
    return refusal(report, "something moved by up to " + in_mm(report.max) +
                               ", and it cannot be told which: the paper (" + words_of(*check.paper) +
                               ") or the tip (" + words_of(tip_mm) +
                               "); touch again, leaning the brush far to another side at each corner");
  return refusal(report,
                 "the touches are up to " + in_mm(report.max) +
                     " off, and neither the paper nor the tip alone explains it: calibrate the pivot, "
                     "then the surface");
}

}  // namespace fude
