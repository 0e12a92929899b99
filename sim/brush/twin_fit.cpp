#include "sim/brush/twin_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

namespace fude {
namespace {

constexpr double margin_mm = 2;
constexpr double difference =
    0.05;  // of a logarithm, either way: beyond what contact hopping from node to node does
constexpr int most_iterations = 12;
constexpr double longest_step = 0.5;
constexpr double settled_step = 2e-3;
constexpr double widest_start = 0.6931;  // a factor of two either way

constexpr std::array<TwinParameter, twin_parameter_count> rows{{
    {"stretch_stiffness", &BrushSpec::stretch_stiffness, "strokes pressed to half the length of the hair"},
    {"stiffness_fall", &BrushSpec::stiffness_fall, "light strokes, and touches"},
    {"spread_bend", &BrushSpec::spread_bend, "strokes pressed to half the length of the hair"},
    {"friction_along", &BrushSpec::friction_along,
     "a stroke that turns a corner, and one the way the handle leans"},
    {"friction_across", &BrushSpec::friction_across, "a stroke square to the way the handle leans"},
    {"plasticity_rad", &BrushSpec::plasticity_rad, "a stroke, lifted off and at once touched down beside it"},
}};

double upper_limit(const TwinParameter& row) {
  for (const BrushParameter& known : brush_parameters())
    if (known.id == row.id) return known.maximum;
  return 1;
}

BrushSpec with(BrushSpec spec, const TwinVector& logs) {
  for (int i = 0; i < twin_parameter_count; ++i) {
    const TwinParameter& row = rows[static_cast<std::size_t>(i)];
    spec.*row.member = std::min(std::exp(logs[i]), upper_limit(row));
  }
  return spec;
}

// Spread evenly over a cube (Halton 1960); the first is the middle.
TwinVector start_offset(int number) {
  constexpr std::array<int, twin_parameter_count> primes{2, 3, 5, 7, 11, 13};
  TwinVector offset = TwinVector::Zero();
  for (int i = 0; number > 0 && i < twin_parameter_count; ++i) {
    const int base = primes[static_cast<std::size_t>(i)];
    double share = 1;
    for (int rest = number; rest > 0; rest /= base) {
      share /= base;
      offset[i] += share * (rest % base);
    }
    offset[i] = widest_start * (2 * offset[i] - 1);
  }
  return offset;
}

struct Point {
  TwinVector logs = TwinVector::Zero();
  Eigen::VectorXd residual;
  std::vector<TwinMark> made;
  double cost() const { return residual.squaredNorm(); }
};

class Fitting {
 public:
  Fitting(const BrushSpec& known, std::span<const TwinTrial> trials,
          const std::function<void(double)>& progress)
      : known_(known), trials_(trials), progress_(progress) {
    for (const TwinTrial& trial : trials) {
      views_.emplace_back(trial.seen, margin_mm);
      seen_.push_back(views_.back().of(trial.seen));
      first_row_.push_back(first_row_.empty() ? 0 : first_row_.back() + seen_[seen_.size() - 2].size());
    }
    rows_ = first_row_.back() + seen_.back().size();
  }

  Point at(const TwinVector& logs) {
    Point point{logs, Eigen::VectorXd(rows_), {}};
    const BrushSpec spec = with(known_, logs);
    for (std::size_t i = 0; i < trials_.size(); ++i) {
      point.made.push_back(perform(spec, trials_[i].hand));
      segment(point.residual, i) = views_[i].of(point.made.back().mark) - seen_[i];
      ++simulated_;
    }
    return point;
  }

  Eigen::MatrixXd derivatives(const TwinVector& logs) {
    Eigen::MatrixXd by(rows_, twin_parameter_count);
    for (int p = 0; p < twin_parameter_count; ++p) {
      const TwinVector step = difference * TwinVector::Unit(p);
      by.col(p) = (at(logs + step).residual - at(logs - step).residual) / (2 * difference);
    }
    return by;
  }

  Point minimum_from(Point here, double done, double share) {
    double damping = 1e-2;
    for (int i = 0; i < most_iterations; ++i) {
      if (progress_) progress_(done + share * i / most_iterations);
      const Eigen::MatrixXd by = derivatives(here.logs);
      const Eigen::Matrix<double, twin_parameter_count, twin_parameter_count> normal = by.transpose() * by;
      const TwinVector slope = by.transpose() * here.residual;
      bool better = false;
      double length = 0;
      for (int tries = 0; tries < 4 && !better; ++tries) {
        auto damped = normal;
        // The small constant keeps what no mark shows from running away.
        damped.diagonal() += damping * normal.diagonal() + TwinVector::Constant(1e-6 * normal.trace());
        const TwinVector step = (-damped.ldlt().solve(slope)).cwiseMax(-longest_step).cwiseMin(longest_step);
        Point there = at(here.logs + step);
        better = there.cost() < here.cost();
        damping = std::clamp(damping * (better ? 0.2 : 8), 1e-5, 1e4);
        if (!better) continue;
        length = step.cwiseAbs().maxCoeff();
        here = std::move(there);
      }
      if (!better || length < settled_step) break;
    }
    return here;
  }

  // The equations of all trials but one.
  TwinVector step_without(std::size_t left_out, const Eigen::MatrixXd& by,
                          const Eigen::VectorXd& residual) const {
    Eigen::Matrix<double, twin_parameter_count, twin_parameter_count> normal;
    normal.setZero();
    TwinVector slope = TwinVector::Zero();
    for (std::size_t i = 0; i < trials_.size(); ++i) {
      if (i == left_out) continue;
      const auto part = by.middleRows(first_row_[i], seen_[i].size());
      normal += part.transpose() * part;
      slope += part.transpose() * residual.segment(first_row_[i], seen_[i].size());
    }
    normal.diagonal().array() += 1e-6 * normal.trace();
    const TwinVector step = -normal.ldlt().solve(slope);
    return step.cwiseMax(-longest_step).cwiseMin(longest_step);
  }

  BrushSpec spec_at(const TwinVector& logs) const { return with(known_, logs); }
  int simulated() const { return simulated_; }

 private:
  Eigen::VectorBlock<Eigen::VectorXd> segment(Eigen::VectorXd& all, std::size_t i) {
    return all.segment(first_row_[i], seen_[i].size());
  }

  const BrushSpec& known_;
  std::span<const TwinTrial> trials_;
  const std::function<void(double)>& progress_;
  std::vector<BlurredView> views_;
  std::vector<Eigen::VectorXd> seen_;
  std::vector<Eigen::Index> first_row_;
  Eigen::Index rows_ = 0;
  int simulated_ = 0;
};

double mean_edge_mm(std::span<const TwinTrial> trials, const std::vector<TwinMark>& made) {
  double sum = 0;
  for (std::size_t i = 0; i < trials.size(); ++i) sum += edge_distance_mm(trials[i].seen, made[i].mark);
  return sum / static_cast<double>(trials.size());
}

// measured = scale × simulated, by least squares.
std::optional<TwinFit::Force> force_scale(std::span<const TwinTrial> trials,
                                          const std::vector<TwinMark>& made) {
  double both = 0;
  double simulated = 0;
  double measured = 0;
  std::size_t samples = 0;
  for (std::size_t i = 0; i < trials.size(); ++i)
    for (std::size_t j = 0; j < trials[i].hand.size(); ++j) {
      const auto& force = trials[i].hand[j].force_mn;
      if (!force) continue;
      both += *force * made[i].force_mn[j];
      simulated += made[i].force_mn[j] * made[i].force_mn[j];
      measured += *force * *force;
      ++samples;
    }
  if (samples == 0 || !(both > 0)) return std::nullopt;
  const double scale = both / simulated;
  return TwinFit::Force{scale, std::sqrt(std::max(0.0, 1 - scale * both / measured)), samples};
}

}  // namespace

std::span<const TwinParameter, twin_parameter_count> twin_parameters() { return rows; }

BrushSpec stiffened(BrushSpec spec, double scale) {
  for (double BrushSpec::*member :
       {&BrushSpec::bend_stiffness, &BrushSpec::stretch_stiffness, &BrushSpec::side_hair_stiffness,
        &BrushSpec::adhesion_mn, &BrushSpec::pore_strength_mn, &BrushSpec::streak_half_mn_mm})
    spec.*member *= scale;
  spec.pore_pressure_lead_mm /= scale;
  return spec;
}

TwinFit fit_twin(const BrushSpec& known, std::span<const TwinTrial> trials, int starts,
                 const std::function<void(double)>& progress) {
  Fitting fitting(known, trials, progress);
  TwinVector first;
  for (int i = 0; i < twin_parameter_count; ++i)
    first[i] = std::log(std::max(known.*rows[static_cast<std::size_t>(i)].member, 1e-3));
  TwinFit fit;
  Point best;
  std::vector<Point> ends;
  const double share = 1.0 / (starts + 1);
  for (int s = 0; s < starts; ++s) {
    Point start = fitting.at(first + start_offset(s));
    if (s == 0) fit.started_mm = mean_edge_mm(trials, start.made);
    ends.push_back(fitting.minimum_from(std::move(start), s * share, share));
    if (s == 0 || ends.back().cost() < best.cost()) best = ends.back();
  }
  // Only ends that are as good: a start may stop in a hollow of its own.
  for (const Point& end : ends)
    if (end.cost() < 1.1 * best.cost())
      fit.starts_differ = std::max(fit.starts_differ, (end.logs - best.logs).cwiseAbs().maxCoeff());

  const Eigen::MatrixXd by = fitting.derivatives(best.logs);
  fit.singular_mm = Eigen::JacobiSVD<Eigen::MatrixXd>(by).singularValues();
  Eigen::Matrix<double, twin_parameter_count, twin_parameter_count> normal = by.transpose() * by;
  normal.diagonal().array() += 1e-9;
  const Eigen::Matrix<double, twin_parameter_count, twin_parameter_count> inverse = normal.inverse();
  fit.shown_mm = inverse.diagonal().cwiseAbs().cwiseMax(1e-12).cwiseSqrt().cwiseInverse();
  // A blurred place is news of one in a blur's area; see BlurredView.
  constexpr double places_in_a_blur = 20;
  const double freedom =
      std::max(1.0, static_cast<double>(best.residual.size()) / places_in_a_blur - twin_parameter_count);
  const TwinVector own = std::sqrt(best.cost() / freedom) * fit.shown_mm.cwiseInverse();
  TwinVector spread = TwinVector::Zero();
  const auto count = static_cast<double>(trials.size());
  for (std::size_t i = 0; i < trials.size(); ++i) {
    fit.edge_mm.push_back(edge_distance_mm(trials[i].seen, best.made[i].mark));
    fit.unconverged += best.made[i].unconverged;
    const TwinVector step = fitting.step_without(i, by, best.residual);
    spread += (count - 1) / count * step.cwiseAbs2();
    const TwinMark foretold = perform(fitting.spec_at(best.logs + step), trials[i].hand);
    fit.held_out_mm.push_back(edge_distance_mm(trials[i].seen, foretold.mark));
  }
  fit.standard_error = own.cwiseMax(spread.cwiseSqrt());
  fit.force = force_scale(trials, best.made);
  fit.spec = stiffened(fitting.spec_at(best.logs), fit.force ? fit.force->scale : 1);
  fit.simulated = fitting.simulated();
  if (progress) progress(1);
  return fit;
}

}  // namespace fude
