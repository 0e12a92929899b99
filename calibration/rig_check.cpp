#include "calibration/rig_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>

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

std::string in_mm(double value) { return in_words(value, 1) + " mm"; }

double tilt_of(const RigMotion& paper) { return paper.turn_rad.head<2>().norm(); }

std::string words_of_paper(const RigMotion& paper) {
  const Eigen::Vector3d& s = paper.shift_mm;
  return in_mm(std::abs(s.x())) + (s.x() < 0 ? " to the left, " : " to the right, ") +
         in_mm(std::abs(s.y())) + (s.y() < 0 ? " down and " : " up and ") + in_mm(std::abs(s.z())) +
         (s.z() < 0 ? " below" : " above") + " where it was, turned by " +
         in_words(degrees(paper.turn_rad.z()), 1) + " and tilted by " + in_words(degrees(tilt_of(paper)), 1) +
         " degrees";
}

std::string words_of_tip(const Eigen::Vector3d& tip_mm) {
  return in_mm(tip_mm.norm()) + " (" + in_words(tip_mm.x(), 1) + ", " + in_words(tip_mm.y(), 1) + ", " +
         in_words(tip_mm.z(), 1) + ") in the frame of its markers";
}

const char* word_of(RigMoved moved) {
  switch (moved) {
    case RigMoved::nothing:
      return "nothing";
    case RigMoved::paper:
      return "paper";
    case RigMoved::tracker:
      return "tracker";
    case RigMoved::tip:
      return "tip";
    case RigMoved::both:
      return "both";
    case RigMoved::unclear:
      break;
  }
  return "unclear";
}

// A paper that slid and a tracker that was moved differ in what they are likely to do, not in kind: either is
// surer than both taken one by one.
RigCheck verdict(const std::vector<RigHypothesis>& hypotheses) {
  double of_tip = 0, of_both = 0;
  const RigHypothesis *tip = nullptr, *both = nullptr, *stand = nullptr;
  for (const RigHypothesis& h : hypotheses) {
    if (h.moved == RigMoved::tip) tip = &h, of_tip = h.probability;
    if (h.moved == RigMoved::both) both = &h, of_both = h.probability;
    if ((h.moved == RigMoved::paper || h.moved == RigMoved::tracker) && stand == nullptr) stand = &h;
  }
  const double of_stand = 1 - of_tip - of_both;
  constexpr double sure = 0.95;
  RigCheck check{RigMoved::unclear, std::max({of_tip, of_both, of_stand}), stand->motion, tip->motion};
  if (of_stand > sure) check.moved = stand->moved;
  if (of_tip > sure) check.moved = RigMoved::tip;
  if (of_both > sure) check = {RigMoved::both, of_both, both->motion, both->motion};
  return check;
}

std::string words_of(const RigCheck& check, double off_mm, bool by_height) {
  const std::string paper = words_of_paper(check.paper), tip = words_of_tip(check.tip.tip_mm);
  switch (check.moved) {
    case RigMoved::paper:
      return "the paper moved: it is " + paper + "; calibrate the surface";
    case RigMoved::tracker:
      return "the tracker moved, or the table with the paper: to the tracker it is " + paper +
             "; calibrate the surface";
    case RigMoved::tip:
      return "the tip moved by " + tip + "; calibrate the pivot";
    case RigMoved::both:
      return "the tip moved by " + tip + ", and the paper too: it is " + paper +
             "; calibrate the pivot, then the surface";
    default:
      return "something moved by up to " + in_mm(off_mm) +
             ", and it cannot be told which: the paper or the tracker (it would be " + paper +
             ") or the tip (by " + tip + "); touch " + (by_height ? "six or more places" : "again") +
             ", leaning the brush far to another side at each";
  }
}

}  // namespace

Fields to_fields(const RigCheck& check) {
  const Eigen::Vector3d &s = check.paper.shift_mm, &t = check.tip.tip_mm;
  return {{"moved", std::string(word_of(check.moved))},
          {"probability", check.probability},
          {"paper_right_mm", s.x()},
          {"paper_up_mm", s.y()},
          {"paper_off_mm", s.z()},
          {"paper_turned_deg", degrees(check.paper.turn_rad.z())},
          {"paper_tilted_deg", degrees(tilt_of(check.paper))},
          {"tip_moved_mm", std::vector{t.x(), t.y(), t.z()}}};
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

std::vector<KnownTouch> RigCheckProcedure::touches() const {
  const auto corners = corners_of(surface_);
  std::vector<KnownTouch> found;
  for (const TipPoint& rest : resting_places(way_)) {
    const Eigen::Vector3d at = surface_.paper_from_tracker * (mm_per_m * rest.point_m);
    const Eigen::Vector3d corner = *std::ranges::min_element(
        corners, {}, [&](const Eigen::Vector3d& c) { return (c - at).squaredNorm(); });
    found.push_back({corner, at, (surface_.paper_from_tracker.rotation * turned_[rest.number]).matrix()});
  }
  return found;
}

std::vector<KnownTouch> RigCheckProcedure::corners_among(const std::vector<KnownTouch>& touched) const {
  if (!corners_) return {};
  const double reach_mm = std::min(surface_.width_mm, surface_.height_mm) / 3;
  std::vector<KnownTouch> near;
  std::ranges::copy_if(touched, std::back_inserter(near), [&](const KnownTouch& touch) {
    return (touch.now_mm - touch.then_mm).norm() < reach_mm;
  });
  const auto different = std::ranges::count_if(corners_of(surface_), [&](const Eigen::Vector3d& corner) {
    return std::ranges::find(near, corner, &KnownTouch::then_mm) != near.end();
  });
  return different < 3 ? std::vector<KnownTouch>{} : near;
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
  std::vector<KnownTouch> touched = touches();
  if (touched.size() < fewest_touches)
    return refusal(report, "the tip rested at " + std::to_string(touched.size()) +
                               " places: rest it for a quarter of a second on three of the paper's corners");
  std::vector<KnownTouch> corners = corners_among(touched);
  if (!corners.empty()) return judged(std::move(report), std::move(corners));
  report.warnings.push_back(
      "three corners of the paper were not touched, or are not known: the height alone is checked");
  for (KnownTouch& touch : touched) {
    const double x = touch.now_mm.x(), y = touch.now_mm.y();
    touch.then_mm = {x, y, height_of(surface_, x, y)};
    touch.height_only = true;
  }
  return judged(std::move(report), std::move(touched));
}

Calibration<RigCheck> RigCheckProcedure::judged(CalibrationReport report,
                                                std::vector<KnownTouch> touched) const {
  const bool by_height = touched.front().height_only;
  std::vector<double> off;
  for (const KnownTouch& touch : touched) off.push_back((touch.now_mm - touch.then_mm).norm());
  summarise(report, off, by_height ? 1 : 3);
  const Eigen::Vector3d middle(surface_.width_mm / 2, surface_.height_mm / 2, 0);
  RigCheck check = verdict(rig_hypotheses(touched, middle));
  if (report.max <= limit_mm) check.moved = RigMoved::nothing, check.probability = 1;
  for (Field& field : to_fields(check)) report.details.push_back(std::move(field));
  if (check.moved != RigMoved::nothing) return refusal(report, words_of(check, report.max, by_height));
  report.accepted = true;
  report.reason = by_height ? "the surface is where it was, to " + in_mm(report.max) + " in height"
                            : "brush and paper are where they were, to " + in_mm(report.max);
  return Calibrated<RigCheck>{check, report};
}

}  // namespace fude
