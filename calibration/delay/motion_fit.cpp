#include "calibration/delay/motion_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace fude {
namespace {

constexpr double step_s = 0.01;
constexpr double shortest_half_s = 0.025;
constexpr double fewest_intervals = 3;  // of either series in half a window
constexpr double block_s = 2;
constexpr std::size_t fewest_blocks = 5;
constexpr double longest_search_s = 120;
constexpr double least_overlap_s = 5;
constexpr double furthest_s = 0.1;
constexpr double apart_s = 0.15;
constexpr std::size_t most_candidates = 4;

struct Motion {
  Eigen::Vector3d rate, bend;
};

std::optional<Motion> motion_at(const Series& series, MotionSeen seen, double t_s, double half_s) {
  const auto local = local_motion(series, t_s, half_s, half_s);
  if (!local) return std::nullopt;
  if (seen == MotionSeen::rates) return Motion{local->value, local->rate};
  return Motion{local->rate, local->bend};
}

double half_window(const Series& a, const Series& b) {
  return std::max({shortest_half_s, fewest_intervals * a.interval_s(), fewest_intervals * b.interval_s()});
}

// Motion on a grid of steps; NaN where it is not known.
Eigen::MatrixX3d sampled(const Series& series, MotionSeen seen, double begin_s, Eigen::Index steps,
                         double half_s) {
  Eigen::MatrixX3d grid(steps, 3);
  for (Eigen::Index i = 0; i < steps; ++i) {
    const auto motion = motion_at(series, seen, begin_s + step_s * double(i), half_s);
    grid.row(i) = motion ? Eigen::RowVector3d(motion->rate.transpose())
                         : Eigen::RowVector3d(Eigen::RowVector3d::Constant(NAN));
  }
  return grid;
}

// Pseudo-inverse of a covariance: axes that hardly move are left out.
Eigen::Matrix3d inverse_of(const Eigen::Matrix3d& covariance) {
  constexpr double least = 1e-6;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  const Eigen::Vector3d values = solver.eigenvalues();
  Eigen::Vector3d inverse = Eigen::Vector3d::Zero();
  for (Eigen::Index i = 0; i < 3; ++i)
    if (values(i) > least * values(2) && values(i) > 0) inverse(i) = 1 / values(i);
  return solver.eigenvectors() * inverse.asDiagonal() * solver.eigenvectors().transpose();
}

// The share of a's motion that a linear map of b's explains, b beginning `lag` steps later in the grid.
double explained(const Eigen::MatrixX3d& a, const Eigen::MatrixX3d& b, Eigen::Index lag) {
  Eigen::Matrix<double, 6, 1> sum = Eigen::Matrix<double, 6, 1>::Zero();
  Eigen::Matrix<double, 6, 6> square = Eigen::Matrix<double, 6, 6>::Zero();
  double n = 0;
  for (Eigen::Index i = std::max<Eigen::Index>(0, -lag); i < a.rows() && i + lag < b.rows(); ++i) {
    Eigen::Matrix<double, 6, 1> both;
    both << a.row(i).transpose(), b.row(i + lag).transpose();
    if (!both.allFinite()) continue;
    sum += both;
    square += both * both.transpose();
    ++n;
  }
  if (n < least_overlap_s / step_s) return 0;
  square -= sum * sum.transpose() / n;
  const Eigen::Matrix3d cross = square.topRightCorner<3, 3>();
  const double whole = square.topLeftCorner<3, 3>().trace();
  const double shared = (cross * inverse_of(square.bottomRightCorner<3, 3>()) * cross.transpose()).trace();
  return whole > 0 ? shared / whole : 0;
}

// Where, in a window of that many rows, a moves most.
Eigen::Index busiest(const Eigen::MatrixX3d& a, Eigen::Index rows) {
  double best = -1, now = 0;
  Eigen::Index at = 0;
  const auto energy = [&](Eigen::Index i) { return a.row(i).allFinite() ? a.row(i).squaredNorm() : 0.0; };
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    now += energy(i);
    if (i >= rows) now -= energy(i - rows);
    if (i + 1 >= rows && now > best) best = now, at = i + 1 - rows;
  }
  return at;
}

struct Moments {
  std::vector<double> t_s;
  Eigen::MatrixX3d a, b, bend;
};

Moments compare(const Series& a, const Series& b, MotionSeen seen, const DelayLine& line, double half_s) {
  const double begin_s = std::max(a.t_s.front(), b.t_s.front() + line.offset_s);
  const double end_s = std::min(a.t_s.back(), b.t_s.back() + line.offset_s);
  Moments moments;
  std::vector<Motion> of_a, of_b;
  for (double t = begin_s; t <= end_s; t += step_s) {
    const auto here = motion_at(a, seen, t, half_s);
    if (!here) continue;
    const auto there = motion_at(b, seen, t - line.at(t), half_s);
    if (!there) continue;
    moments.t_s.push_back(t);
    of_a.push_back(*here);
    of_b.push_back(*there);
  }
  const auto n = Eigen::Index(of_a.size());
  moments.a.resize(n, 3);
  moments.b.resize(n, 3);
  moments.bend.resize(n, 3);
  for (Eigen::Index i = 0; i < n; ++i) {
    moments.a.row(i) = of_a[std::size_t(i)].rate;
    moments.b.row(i) = of_b[std::size_t(i)].rate;
    moments.bend.row(i) = of_b[std::size_t(i)].bend;
  }
  return moments;
}

}  // namespace

std::vector<MotionCandidate> search_motion(const Series& a, const Series& b, MotionSeen seen,
                                           double range_s) {
  std::vector<MotionCandidate> found;
  if (a.size() < 2 || b.size() < 2) return found;
  const double half_s = half_window(a, b);
  const double begin_s = std::max(a.t_s.front(), b.t_s.front() - range_s);
  const double end_s = std::min(a.t_s.back(), b.t_s.back() + range_s);
  if (!(end_s - begin_s > least_overlap_s)) return found;
  Eigen::MatrixX3d of_a = sampled(a, seen, begin_s, Eigen::Index((end_s - begin_s) / step_s), half_s);
  const Eigen::Index rows = std::min(of_a.rows(), Eigen::Index(longest_search_s / step_s));
  const Eigen::Index first = busiest(of_a, rows);
  of_a = of_a.middleRows(first, rows).eval();
  const auto lags = Eigen::Index(range_s / step_s);
  const double b_begin_s = begin_s + step_s * double(first - lags);
  const Eigen::MatrixX3d of_b = sampled(b, seen, b_begin_s, rows + 2 * lags, half_s);
  const double reference_s = begin_s + step_s * (double(first) + double(rows) / 2);
  std::vector<MotionCandidate> all;
  for (Eigen::Index lag = 0; lag <= 2 * lags; ++lag)
    all.push_back({{step_s * double(lags - lag), 0, reference_s}, explained(of_a, of_b, lag)});
  std::sort(all.begin(), all.end(), [](const auto& x, const auto& y) { return x.explained > y.explained; });
  for (const MotionCandidate& candidate : all) {
    if (found.size() == most_candidates || candidate.explained <= 0) break;
    const bool near = std::any_of(found.begin(), found.end(), [&](const MotionCandidate& other) {
      return std::abs(other.line.offset_s - candidate.line.offset_s) < apart_s;
    });
    if (!near) found.push_back(candidate);
  }
  return found;
}

std::optional<MotionFit> fit_motion(const Series& a, const Series& b, MotionSeen seen, const DelayLine& start,
                                    bool drifts) {
  if (a.size() < 2 || b.size() < 2) return std::nullopt;
  const double half_s = half_window(a, b);
  MotionFit fit;
  fit.line = start;
  fit.line.reference_s = (std::max(a.t_s.front(), b.t_s.front() + start.offset_s) +
                          std::min(a.t_s.back(), b.t_s.back() + start.offset_s)) /
                         2;
  fit.line.offset_s = start.at(fit.line.reference_s);
  constexpr int most_rounds = 12;
  for (int round = 0; round < most_rounds; ++round) {
    const Moments m = compare(a, b, seen, fit.line, half_s);
    const Eigen::Index n = m.a.rows();
    if (double(n) * step_s < double(fewest_blocks) * block_s) return std::nullopt;
    const Eigen::RowVector3d mean_a = m.a.colwise().mean(), mean_b = m.b.colwise().mean();
    const Eigen::MatrixX3d ac = m.a.rowwise() - mean_a, bc = m.b.rowwise() - mean_b;
    const Eigen::Matrix3d bb = inverse_of(bc.transpose() * bc);
    const Eigen::Matrix3d map = bb * (bc.transpose() * ac);
    const Eigen::MatrixX3d off = ac - bc * map;
    // What the offset changes, less what another map would change as well.
    const Eigen::MatrixX3d pushed = m.bend * map;
    const auto own = [&](const Eigen::MatrixX3d& moved) -> Eigen::MatrixX3d {
      const Eigen::MatrixX3d centred = moved.rowwise() - moved.colwise().mean();
      return centred - bc * (bb * (bc.transpose() * centred));
    };
    Eigen::MatrixX3d later = pushed;
    for (Eigen::Index i = 0; i < n; ++i) later.row(i) *= m.t_s[std::size_t(i)] - fit.line.reference_s;
    const Eigen::MatrixX3d by_offset = own(pushed), by_drift = own(later);
    Eigen::Matrix2d square;
    square << by_offset.squaredNorm(), by_offset.cwiseProduct(by_drift).sum(), 0, by_drift.squaredNorm();
    square(1, 0) = square(0, 1);
    Eigen::Vector2d pull(-by_offset.cwiseProduct(off).sum(), -by_drift.cwiseProduct(off).sum());
    Eigen::Matrix2d inverse = Eigen::Matrix2d::Zero();
    if (!(square(0, 0) > 0)) return std::nullopt;
    if (drifts)
      inverse = square.inverse();
    else
      inverse(0, 0) = 1 / square(0, 0);
    const Eigen::Vector2d change = inverse * pull;
    fit.line.offset_s += change(0);
    fit.line.drift += change(1);
    if (!(std::abs(fit.line.offset_s - start.at(fit.line.reference_s)) < furthest_s)) return std::nullopt;
    constexpr double settled_s = 1e-7;
    if (std::abs(change(0)) > settled_s && round + 1 < most_rounds) continue;

    fit.moments = std::size_t(n);
    fit.explained = 1 - off.squaredNorm() / ac.squaredNorm();
    Eigen::Matrix2d scores = Eigen::Matrix2d::Zero();
    for (Eigen::Index first = 0; first < n;) {
      MotionBlock block;
      Eigen::Vector2d score = Eigen::Vector2d::Zero();
      Eigen::Index end = first;
      for (; end < n && m.t_s[std::size_t(end)] < m.t_s[std::size_t(first)] + block_s; ++end) {
        score -= Eigen::Vector2d(by_offset.row(end).dot(off.row(end)), by_drift.row(end).dot(off.row(end)));
        block.information += by_offset.row(end).squaredNorm();
        block.squares += off.row(end).squaredNorm();
        block.motion += ac.row(end).squaredNorm();
      }
      block.pull = score(0);
      block.t_s = (m.t_s[std::size_t(first)] + m.t_s[std::size_t(end - 1)]) / 2;
      // A block pulls the line towards itself, and its score with it.
      const double lever = std::min(0.9, block.information / square(0, 0));
      scores += score * score.transpose() / ((1 - lever) * (1 - lever));
      fit.blocks.push_back(block);
      first = end;
    }
    if (fit.blocks.size() < fewest_blocks) return std::nullopt;
    fit.freedom = double(fit.blocks.size()) - (drifts ? 2 : 1);
    const Eigen::Matrix2d covariance = inverse * scores * inverse;
    fit.offset_sd_s = std::sqrt(covariance(0, 0));
    if (drifts) fit.drift_sd = std::sqrt(covariance(1, 1));
    break;
  }
  return fit;
}

}  // namespace fude
