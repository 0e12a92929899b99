#include "calibration/distortion.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

#include "calibration/fusion/motion_state.h"
#include "calibration/motion_pairs.h"
#include "signal/units.h"

namespace fude {
namespace {

constexpr double mm_per_m = 1e3;
constexpr std::size_t fewest_cells = 20, enough_cells = 60, most_cells = 200;
constexpr double flattest = 0.08;   // least extent by the largest
constexpr double least_gain = 0.8;  // held out, of what there was before
constexpr double worst_rms_mm = 5, fair_rms_mm = 2;
constexpr double outlier_factor = 10;  // times the typical residual
constexpr double most_outliers = 0.1;
constexpr int folds = 5;

double in_deg(double radians) { return in_degrees(Radians(radians)); }

// Places near one another, as one; and which place went where.
struct Cells {
  Eigen::MatrixXd at_m, shift_m, turn_rad;  // a row each
  std::vector<std::size_t> of_place;
};

Cells gathered(const std::vector<MappedPlace>& places, double size_m) {
  std::map<std::array<long, 3>, std::size_t> numbers;
  Cells cells;
  std::vector<double> counts;
  for (const MappedPlace& place : places) {
    std::array<long, 3> key{};
    for (std::size_t k = 0; k < 3; ++k) key[k] = std::lround(place.at_m(Eigen::Index(k)) / size_m);
    cells.of_place.push_back(numbers.try_emplace(key, numbers.size()).first->second);
  }
  for (Eigen::MatrixXd* m : {&cells.at_m, &cells.shift_m, &cells.turn_rad})
    *m = Eigen::MatrixXd::Zero(Eigen::Index(numbers.size()), 3);
  counts.assign(numbers.size(), 0);
  for (const std::size_t cell : cells.of_place) ++counts[cell];
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::size_t cell = cells.of_place[i];
    const double share = 1 / counts[cell];
    cells.at_m.row(Eigen::Index(cell)) += share * places[i].at_m.transpose();
    cells.shift_m.row(Eigen::Index(cell)) += share * places[i].shift_m.transpose();
    if (places[i].turn_rad) cells.turn_rad.row(Eigen::Index(cell)) += share * places[i].turn_rad->transpose();
  }
  return cells;
}

// As small as may be: the grid of a list stays as it is.
Cells cells_of(const std::vector<MappedPlace>& places) {
  double size_m = 1e-3;
  Cells cells = gathered(places, size_m);
  while (cells.at_m.rows() > Eigen::Index(most_cells)) cells = gathered(places, size_m *= 1.1);
  return cells;
}

// Of the two degrees of freedom in shape the one that foretells left-out values better.
SmoothField smooth(const Eigen::MatrixXd& at_m, const Eigen::MatrixXd& values) {
  SmoothField thin = SmoothField::fit(at_m, values, FreeShape::plane);
  SmoothField bowl = SmoothField::fit(at_m, values, FreeShape::quadric);
  return bowl.left_out_residuals().norm() < thin.left_out_residuals().norm() ? bowl : thin;
}

// How far it holds: to the middle between mapped places, were they a grid, and a little more.
double reach_m(const Eigen::MatrixXd& at_m) {
  std::vector<double> nearest;
  for (Eigen::Index i = 0; i < at_m.rows(); ++i) {
    double least = std::numeric_limits<double>::infinity();
    for (Eigen::Index j = 0; j < at_m.rows(); ++j)
      if (j != i) least = std::min(least, (at_m.row(i) - at_m.row(j)).norm());
    nearest.push_back(least);
  }
  return 1.2 * quantile(std::move(nearest), 0.9);
}

DistortionField field_of(const Cells& cells, const std::vector<Eigen::Index>& chosen, bool turns) {
  Eigen::MatrixXd at(Eigen::Index(chosen.size()), 3), shift = at, turn = at;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    at.row(Eigen::Index(i)) = cells.at_m.row(chosen[i]);
    shift.row(Eigen::Index(i)) = cells.shift_m.row(chosen[i]);
    turn.row(Eigen::Index(i)) = cells.turn_rad.row(chosen[i]);
  }
  DistortionField field{smooth(at, shift), std::nullopt, reach_m(at)};
  if (turns) field.turn_rad = smooth(at, turn);
  return field;
}

struct Left {
  double shift_mm = 0, turn_deg = 0;
};
Left left_by(const DistortionField& field, const MappedPlace& place) {
  const Eigen::RowVector3d at = place.at_m.transpose();
  Left left{mm_per_m * (place.shift_m.transpose() - field.shift_m.at(at)).norm(), 0};
  if (field.turn_rad && place.turn_rad)
    left.turn_deg = in_deg((place.turn_rad->transpose() - field.turn_rad->at(at)).norm());
  return left;
}

std::vector<Left> left_by(const DistortionField& field, const std::vector<MappedPlace>& places) {
  std::vector<Left> left;
  for (const MappedPlace& place : places) left.push_back(left_by(field, place));
  return left;
}

std::vector<Eigen::Index> every_of(const Cells& cells) {
  std::vector<Eigen::Index> every(std::size_t(cells.at_m.rows()));
  std::iota(every.begin(), every.end(), Eigen::Index(0));
  return every;
}

// Every place by the field of the cells that are not of its fold.
std::vector<Left> held_out(const std::vector<MappedPlace>& places, const Cells& cells, bool turns) {
  std::vector<Left> left(places.size());
  for (int fold = 0; fold < folds; ++fold) {
    std::vector<Eigen::Index> others;
    for (Eigen::Index cell = 0; cell < cells.at_m.rows(); ++cell)
      if (cell % folds != fold) others.push_back(cell);
    const DistortionField field = field_of(cells, others, turns);
    for (std::size_t i = 0; i < places.size(); ++i)
      if (int(cells.of_place[i] % std::size_t(folds)) == fold) left[i] = left_by(field, places[i]);
  }
  return left;
}

std::vector<double> shifts_of(const std::vector<Left>& left) {
  std::vector<double> shifts;
  for (const Left& l : left) shifts.push_back(l.shift_mm);
  return shifts;
}
std::vector<double> turns_of(const std::vector<Left>& left) {
  std::vector<double> turns;
  for (const Left& l : left) turns.push_back(l.turn_deg);
  return turns;
}

// Less what is everywhere the same: that is no distortion.
std::vector<double> before_mm(const std::vector<MappedPlace>& places) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const MappedPlace& place : places) mean += place.shift_m / double(places.size());
  std::vector<double> lengths;
  for (const MappedPlace& place : places) lengths.push_back(mm_per_m * (place.shift_m - mean).norm());
  return lengths;
}
std::vector<double> turns_before_deg(const std::vector<MappedPlace>& places) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const MappedPlace& place : places) mean += *place.turn_rad / double(places.size());
  std::vector<double> lengths;
  for (const MappedPlace& place : places) lengths.push_back(in_deg((*place.turn_rad - mean).norm()));
  return lengths;
}

Eigen::Vector3d extents(const std::vector<MappedPlace>& places) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const MappedPlace& place : places) mean += place.at_m / double(places.size());
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const MappedPlace& place : places) scatter += (place.at_m - mean) * (place.at_m - mean).transpose();
  return (scatter / double(places.size()))
      .selfadjointView<Eigen::Lower>()
      .eigenvalues()
      .cwiseMax(0)
      .cwiseSqrt();
}

}  // namespace

std::vector<MappedPlace> places_of_motion(std::span<const PoseSample> magnetic,
                                          std::span<const PoseSample> undisturbed) {
  const PairedMotion motion = pair_motion(magnetic, undisturbed);
  std::vector<MappedPlace> places;
  if (motion.pairs.size() < fewest_motion_pairs) return places;
  const HandEye& fit = motion.robust.fit;
  for (const MotionPair& pair : motion.pairs) {
    const auto truth = fit.tracker_from_other * pair.other * fit.tool_from_other.inverse();
    places.push_back({pair.seen.translation, truth.translation - pair.seen.translation,
                      turn_of(truth.rotation * pair.seen.rotation.conjugate())});
  }
  return places;
}

std::vector<MappedPlace> places_of_grid(std::span<const Pose<Tracker, Tool>> touched,
                                        const Eigen::Vector3d& tip_m, const std::vector<Landmark>& grid) {
  Points3 tips, true_points;
  for (const auto& pose : touched) tips.push_back(pose * tip_m);
  for (const Landmark& landmark : grid) true_points.push_back(landmark.at_m);
  const Similarity tracker_from_grid = register_points(true_points, tips, Freedom::rigid);
  std::vector<MappedPlace> places;
  for (std::size_t i = 0; i < touched.size(); ++i)
    places.push_back({touched[i].translation, tracker_from_grid(true_points[i]) - tips[i], std::nullopt});
  return places;
}

Progress DistortionProcedure::add(const MappedPlace& place) {
  const bool sound =
      place.at_m.allFinite() && place.shift_m.allFinite() && (!place.turn_rad || place.turn_rad->allFinite());
  if (sound)
    places_.push_back(place);
  else
    ++unusable_;
  const double share = double(places_.size()) / double(enough_cells);
  return {places_.size(), std::min(1.0, share), share < 1 ? "more places, at every height" : ""};
}

Calibration<DistortionField> DistortionProcedure::finish() const {
  CalibrationReport report;
  report.procedure = "distortion";
  report.to_frame = "tracker";
  report.from_frame = "tracker as it measures";
  report.n = places_.size();
  if (unusable_ > 0)
    report.warnings.push_back(std::to_string(unusable_) + " places were left out: no numbers");
  if (places_.size() < fewest_cells)
    return refusal(report, "only " + std::to_string(places_.size()) + " places were mapped, " +
                               std::to_string(fewest_cells) + " are the fewest, at every height");
  const Eigen::Vector3d extent = extents(places_);
  if (extent(2) > 0) report.condition = extent(2) / std::max(1e-9, extent(0));
  if (!(extent(0) > flattest * extent(2)))
    return refusal(report,
                   "the mapped places lie on one plane, line or point: map every height of the volume");
  const bool turns = std::all_of(places_.begin(), places_.end(),
                                 [](const MappedPlace& p) { return p.turn_rad.has_value(); });

  std::vector<MappedPlace> used = places_;
  Cells cells = cells_of(used);
  if (cells.at_m.rows() < Eigen::Index(fewest_cells))
    return refusal(report, "only " + std::to_string(cells.at_m.rows()) + " different places were mapped, " +
                               std::to_string(fewest_cells) +
                               " are the fewest: move through the whole volume");
  const std::vector<double> off_mm = shifts_of(left_by(field_of(cells, every_of(cells), turns), used));
  const double limit = outlier_factor * std::max(0.05, quantile(off_mm, 0.5));
  std::vector<MappedPlace> sound;
  for (std::size_t i = 0; i < used.size(); ++i)
    if (off_mm[i] < limit) sound.push_back(used[i]);
  const std::size_t outliers = used.size() - sound.size();
  if (outliers > 0 && sound.size() >= fewest_cells) {
    used = std::move(sound);
    cells = cells_of(used);
  }
  const DistortionField field = field_of(cells, every_of(cells), turns);
  const std::vector<Left> after = left_by(field, used), left = held_out(used, cells, turns);
  const double was_mm = root_mean_square(before_mm(used));
  const double foretold_mm = root_mean_square(shifts_of(left));
  summarise(report, shifts_of(after), 3);
  report.held_out_rms = foretold_mm;
  report.ci95 = {0, quantile(shifts_of(left), 0.95)};
  report.detail("before_rms_mm", was_mm);
  report.detail("mapped_places", double(cells.at_m.rows()));
  report.detail("outliers", double(outliers));
  report.detail("reach_mm", mm_per_m * field.reach_m);
  if (turns) {
    report.detail("before_turn_rms_deg", root_mean_square(turns_before_deg(used)));
    report.detail("turn_rms_deg", root_mean_square(turns_of(after)));
    report.detail("held_out_turn_rms_deg", root_mean_square(turns_of(left)));
  }
  const std::string before_after = in_words(was_mm) + " mm before, " + in_words(foretold_mm) + " mm after";
  if (double(outliers) > most_outliers * double(places_.size()))
    return refusal(report, std::to_string(outliers) + " of " + std::to_string(places_.size()) +
                               " places do not fit their neighbours: did iron move, or the tracker flip?");
  if (foretold_mm > worst_rms_mm)
    return refusal(report, "a smooth field leaves too much (" + before_after +
                               "): map more places, or move the iron away");
  if (foretold_mm > least_gain * was_mm)
    return refusal(report, "a smooth field does not help (" + before_after +
                               "): there is little distortion here, or too few places to see it");
  if (outliers > 0)
    report.warnings.push_back(std::to_string(outliers) + " places are outliers, by more than " +
                              in_words(limit, 1) + " mm, and were left out");
  if (!turns) report.warnings.push_back("the orientation stays as it is: points say nothing of it");
  if (foretold_mm > fair_rms_mm)
    report.warnings.push_back("what is left is " + in_words(foretold_mm) + " mm: map more places");
  report.accepted = true;
  report.reason =
      "places are known to within " + in_words((*report.ci95)[1]) + " mm (95 %; " + before_after + ")";
  return Calibrated<DistortionField>{field, report};
}

}  // namespace fude
