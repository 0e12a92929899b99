#include "rig/calibration/brush_twin.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

#include "sim/brush/twin_fit.h"

namespace fude {
namespace {

constexpr std::size_t fewest_trials = 5;
constexpr double z_of_95 = 1.96;
constexpr double widest_ci = 0.25;           // relative; beyond it a parameter counts as not shown
constexpr double faintest_mm = 0.4;          // by which an e-fold must change the marks
constexpr double largest_edge_share = 0.12;  // of the belly's radius, that edges may be off

Eigen::Vector2d middle_of(const Mark& mark) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double weight = 1e-12;
  for (int r = 0; r < mark.rows; ++r)
    for (int c = 0; c < mark.columns; ++c) {
      const auto cover = static_cast<double>(
          mark.covered[static_cast<std::size_t>(r) * static_cast<std::size_t>(mark.columns) +
                       static_cast<std::size_t>(c)]);
      sum += cover * Eigen::Vector2d(mark.left_mm + (c + 0.5) * mark.cell_mm,
                                     mark.bottom_mm + (r + 0.5) * mark.cell_mm);
      weight += cover;
    }
  return sum / weight;
}

// How far the brush goes over the paper while its hair may touch.
double travel_mm(const TwinTrial& trial, double reach_mm) {
  double travel = 0;
  for (std::size_t i = 1; i < trial.hand.size(); ++i) {
    const Eigen::Vector3d& from = trial.hand[i - 1].paper_from_handle.translation;
    const Eigen::Vector3d& to = trial.hand[i].paper_from_handle.translation;
    if (to.z() < 0.9 * reach_mm) travel += (to - from).head<2>().norm();
  }
  return travel;
}

// What is wrong with the gestures; empty where nothing is.
std::string wrong_with_hands(const BrushSpec& known, std::span<const TwinTrial> trials) {
  if (trials.size() < fewest_trials)
    return "too few footprints: " + std::to_string(trials.size()) + ", and " + std::to_string(fewest_trials) +
           " are the fewest";
  double farthest = 0;
  for (const TwinTrial& trial : trials) {
    double lowest = 1e9;
    double highest = -1e9;
    for (const HandMoment& moment : trial.hand) {
      lowest = std::min(lowest, moment.paper_from_handle.translation.z());
      highest = std::max(highest, moment.paper_from_handle.translation.z());
    }
    if (highest < 1)
      return trial.name + ": no height above 1 mm: poses are of the root of the hair, in millimetres";
    if (lowest > known.tuft_length_mm)
      return trial.name + ": the hair never reaches the paper: the root stays " + in_words(lowest, 1) +
             " mm above it, and the hair is " + in_words(known.tuft_length_mm, 1) + " mm long";
    farthest = std::max(farthest, travel_mm(trial, known.tuft_length_mm));
  }
  if (farthest < 0.4 * known.tuft_length_mm)
    return "no trial drags the brush over the paper: friction is not seen; add strokes along and across";
  return {};
}

double median(std::vector<double> values) { return quantile(std::move(values), 0.5); }

// The marks against those of the brush as it is known: of another scale, or elsewhere?
std::string wrong_with_marks(const BrushSpec& known, std::span<const TwinTrial> trials) {
  std::vector<double> scale;
  std::vector<double> right;
  std::vector<double> up;
  for (const TwinTrial& trial : trials) {
    const TwinMark made = perform(known, trial.hand);
    if (made.mark.columns == 0) continue;
    scale.push_back(std::sqrt(trial.seen.area_mm2() / made.mark.area_mm2()));
    const Eigen::Vector2d apart = middle_of(trial.seen) - middle_of(made.mark);
    right.push_back(apart.x());
    up.push_back(apart.y());
  }
  if (scale.size() < fewest_trials)
    return "with these poses most trials would leave no mark: check their heights";
  const double times = median(scale);
  if (times > 1.6 || times < 0.62)
    return "the marks are " + in_words(times) +
           " times as large as this brush would leave: check mm_per_pixel, and the brush's lengths";
  const Eigen::Vector2d apart(median(right), median(up));
  if (apart.norm() > 0.3 * known.tuft_length_mm)
    return "the marks lie " + in_words(apart.x(), 1) + ", " + in_words(apart.y(), 1) +
           " mm from where the poses leave them: check left_mm and bottom_mm, and that poses are of the root "
           "of the hair";
  return {};
}

void tell(const TwinFit& fit, CalibrationReport& report) {
  summarise(report, fit.edge_mm, 1);
  report.held_out_rms = root_mean_square(fit.held_out_mm);
  const double smallest = fit.singular_mm[twin_parameter_count - 1];
  if (smallest > 0) report.condition = fit.singular_mm[0] / smallest;
  report.ci95 = {0, z_of_95 * fit.standard_error.maxCoeff()};
  std::vector<std::string> names;
  std::vector<double> ci;
  std::vector<double> shown;
  std::vector<double> singular;
  for (int i = 0; i < twin_parameter_count; ++i) {
    names.emplace_back(twin_parameters()[static_cast<std::size_t>(i)].id);
    ci.push_back(100 * z_of_95 * fit.standard_error[i]);
    shown.push_back(fit.shown_mm[i]);
    singular.push_back(fit.singular_mm[i]);
  }
  report.detail("parameters", names);
  report.detail("ci95_percent", ci);
  report.detail("shown_mm", shown);
  report.detail("singular_mm", singular);
  report.detail("edge_mm", fit.edge_mm);
  report.detail("held_out_mm", fit.held_out_mm);
  report.detail("edge_before_mm", fit.started_mm);
  report.detail("gestures_simulated", double(fit.simulated));
  if (fit.force) {
    report.detail("force_samples", double(fit.force->samples));
    report.detail("force_left_percent", 100 * fit.force->rms_share);
  }
}

void warn(const TwinFit& fit, CalibrationReport& report) {
  if (!fit.force)
    report.warnings.push_back(
        "no force was measured: ratios alone are known, and forces are those of the brush it began with");
  else if (fit.force->rms_share > 0.3)
    report.warnings.push_back(
        "the measured forces hardly go with the simulated ones: check that they are newtons, and of the same "
        "moments");
  if (fit.starts_differ > 0.1)
    report.warnings.push_back("searches from different places end " + in_words(100 * fit.starts_differ, 0) +
                              " % apart with marks as good: more gestures would tell");
  if (report.held_out_rms && *report.held_out_rms > 2 * report.rms + 0.05)
    report.warnings.push_back(
        "a trial is foretold by the others far worse than it is fitted: one may be of another kind, or more "
        "are needed");
  if (fit.unconverged > 0)
    report.warnings.push_back(std::to_string(fit.unconverged) + " simulated frames did not converge");
}

// The parameter that is known worst, where it is not known well enough.
std::string not_shown(const TwinFit& fit) {
  int worst = -1;
  for (int i = 0; i < twin_parameter_count; ++i) {
    const bool unknown = fit.shown_mm[i] < faintest_mm || z_of_95 * fit.standard_error[i] > widest_ci;
    if (unknown && (worst < 0 || fit.standard_error[i] > fit.standard_error[worst])) worst = i;
  }
  if (worst < 0) return {};
  const TwinParameter& row = twin_parameters()[static_cast<std::size_t>(worst)];
  return "the footprints do not tell " + std::string(row.id) + " (known within " +
         in_words(100 * z_of_95 * fit.standard_error[worst], 0) + " %): add " + std::string(row.shown_by);
}

std::string plain(double value) {
  std::ostringstream text;
  text.precision(6);
  text << value;
  return text.str();
}

}  // namespace

BrushTwin twin_of(const BrushSpec& known, std::span<const TwinTrial> trials, int starts,
                  const std::function<void(double)>& progress) {
  BrushTwin twin{{}, known};
  CalibrationReport& report = twin.outcome.report;
  report.procedure = "brush";
  report.to_frame = "paper";
  report.from_frame = "handle";
  report.n = trials.size();
  report.reason = wrong_with_hands(known, trials);
  if (report.reason.empty()) report.reason = wrong_with_marks(known, trials);
  if (!report.reason.empty()) return twin;

  const TwinFit fit = fit_twin(known, trials, starts, progress);
  tell(fit, report);
  const double largest = largest_edge_share * known.belly_radius_mm;
  if (report.rms > largest) {
    report.reason = "no brush of these lengths leaves such marks: edges are " + in_words(report.rms) +
                    " mm off, and " + in_words(largest) +
                    " would do; check lengths and radii, mm_per_pixel and the poses";
    return twin;
  }
  report.reason = not_shown(fit);
  if (!report.reason.empty()) return twin;
  warn(fit, report);
  report.accepted = true;
  report.reason = "edges within " + in_words(report.rms) + " mm, foretold within " +
                  in_words(*report.held_out_rms) + "; the worst-known parameter within " +
                  in_words(100 * (*report.ci95)[1], 0) + " %";
  twin.spec = fit.spec;
  Fields found;
  for (const TwinParameter& row : twin_parameters())
    found.push_back({std::string(row.id), fit.spec.*row.member});
  found.push_back({"bend_stiffness", fit.spec.bend_stiffness});
  twin.outcome.result = std::move(found);
  return twin;
}

std::string toml_of(const BrushSpec& spec, const std::string& remark) {
  std::string text = "# " + remark + "\nname = \"" + spec.name + "\"\n";
  const BrushSpec standard;
  for (const BrushParameter& row : brush_parameters())
    if (spec.*row.member != standard.*row.member)
      text += std::string(row.id) + " = " + plain(spec.*row.member) + "\n";
  for (const BrushSwitch& row : brush_switches())
    if (spec.*row.member != standard.*row.member)
      text += std::string(row.id) + " = " + (spec.*row.member ? "true" : "false") + "\n";
  return text;
}

}  // namespace fude
