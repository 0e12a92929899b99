#include "sim/brush/quadratic_program.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace fude {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double violation_tolerance = 1e-11;
constexpr int max_exchanges = 400;

class DualActiveSet {
 public:
  explicit DualActiveSet(const QuadraticProgram& p)
      : p_(p), n_(static_cast<int>(p.gradient.size())), m_(static_cast<int>(p.right.size())) {}

  QuadraticSolution run();

 private:
  // Constraints are numbered: rows, then lower bounds, then upper bounds.
  double slack(int c) const {
    if (c < m_) return p_.rows.row(c).dot(d_) - p_.right[c];
    if (c < m_ + n_) return d_[c - m_] - p_.low[c - m_];
    return p_.high[c - m_ - n_] - d_[c - m_ - n_];
  }
  // basisᵀ times the constraint's normal.
  void project_normal(int c) {
    if (c < m_) {
      projected_.noalias() = basis_.transpose() * p_.rows.row(c).transpose();
    } else if (c < m_ + n_) {
      projected_ = basis_.row(c - m_).transpose();
    } else {
      projected_ = -basis_.row(c - m_ - n_).transpose();
    }
  }
  int most_violated() const;
  void start();
  bool take_up(int c);
  void append(int c, double multiplier, double free_length);
  void drop(int position);

  const QuadraticProgram& p_;
  const int n_;
  const int m_;
  Variables d_;
  Variables projected_;
  Variables direction_;
  SquareMatrix basis_;     // L⁻ᵀ Q: its first columns span the active normals
  SquareMatrix triangle_;  // R
  int active_count_ = 0;
  std::array<int, max_variables> active_{};
  Variables multipliers_;  // of the active constraints
  Variables dual_step_;
  std::array<bool, max_constraints + 2 * max_variables> is_active_{};
};

void DualActiveSet::start() {
  basis_ = p_.inverse_factor;
  projected_.noalias() = basis_.transpose() * p_.gradient;
  d_.noalias() = -(basis_ * projected_);
  triangle_.setZero(n_, n_);
  multipliers_.setZero(n_);
  dual_step_.setZero(n_);
  direction_.setZero(n_);
}

int DualActiveSet::most_violated() const {
  int worst = -1;
  double least = -violation_tolerance;
  for (int c = 0; c < m_ + 2 * n_; ++c) {
    if (is_active_[static_cast<std::size_t>(c)]) continue;
    const double s = slack(c);
    if (s < least) {
      least = s;
      worst = c;
    }
  }
  return worst;
}

// `direction_` is the free columns of the basis times the projected normal's free part, whose length is
// given.
void DualActiveSet::append(int c, double multiplier, double free_length) {
  // A Householder reflection of the free columns leaves the projected normal with nothing below its new
  // diagonal entry.
  const int q = active_count_;
  const int rest = n_ - q;
  const double turned = projected_[q] > 0 ? -free_length : free_length;
  projected_[q] -= turned;
  const double half_square = -turned * projected_[q];  // of the mirror's normal
  if (half_square > 0) {
    direction_ -= turned * basis_.col(q);
    for (int j = 0; j < rest; ++j) {
      const double share = projected_[q + j] / half_square;
      if (share != 0) basis_.col(q + j) -= share * direction_;
    }
  }
  projected_[q] = turned;
  triangle_.col(active_count_).head(active_count_ + 1) = projected_.head(active_count_ + 1);
  active_[static_cast<std::size_t>(active_count_)] = c;
  multipliers_[active_count_] = multiplier;
  is_active_[static_cast<std::size_t>(c)] = true;
  ++active_count_;
}

void DualActiveSet::drop(int position) {
  is_active_[static_cast<std::size_t>(active_[static_cast<std::size_t>(position)])] = false;
  for (int j = position; j + 1 < active_count_; ++j) {
    active_[static_cast<std::size_t>(j)] = active_[static_cast<std::size_t>(j + 1)];
    multipliers_[j] = multipliers_[j + 1];
    triangle_.col(j).head(j + 2) = triangle_.col(j + 1).head(j + 2);
  }
  --active_count_;
  for (int j = position; j < active_count_; ++j) {
    const double a = triangle_(j, j);
    const double b = triangle_(j + 1, j);
    const double h = std::sqrt(a * a + b * b);
    if (h == 0) continue;
    const double cosine = a / h;
    const double sine = b / h;
    for (int k = j; k < active_count_; ++k) {
      const double upper = triangle_(j, k);
      triangle_(j, k) = cosine * upper + sine * triangle_(j + 1, k);
      triangle_(j + 1, k) = cosine * triangle_(j + 1, k) - sine * upper;
    }
    const Variables left = basis_.col(j);
    basis_.col(j) = cosine * left + sine * basis_.col(j + 1);
    basis_.col(j + 1) = cosine * basis_.col(j + 1) - sine * left;
  }
}

// Brings constraint c to its boundary, dropping others on the way; false where that is impossible.
bool DualActiveSet::take_up(int c) {
  double multiplier = 0;
  for (int exchange = 0; exchange < max_exchanges; ++exchange) {
    project_normal(c);
    const int q = active_count_;
    const double length = projected_.squaredNorm();
    const double free_square = projected_.tail(n_ - q).squaredNorm();
    dual_step_.head(q) = projected_.head(q);
    for (int i = q - 1; i >= 0; --i) {
      dual_step_[i] /= triangle_(i, i);
      dual_step_.head(i) -= dual_step_[i] * triangle_.col(i).head(i);
    }
    double partial = infinite;
    int leaving = -1;
    for (int i = 0; i < q; ++i) {
      if (dual_step_[i] > 0 && multipliers_[i] / dual_step_[i] < partial) {
        partial = multipliers_[i] / dual_step_[i];
        leaving = i;
      }
    }
    const bool movable = free_square > 1e-13 * length;
    const double full = movable ? -slack(c) / free_square : infinite;
    const double step = std::min(partial, full);
    if (step == infinite) return false;
    multipliers_.head(q) -= step * dual_step_.head(q);
    multiplier += step;
    if (movable) {
      direction_.noalias() = basis_.rightCols(n_ - q) * projected_.tail(n_ - q);
      d_ += step * direction_;
    }
    if (movable && full <= partial) {
      append(c, multiplier, std::sqrt(free_square));
      return true;
    }
    drop(leaving);
  }
  return false;
}

QuadraticSolution DualActiveSet::run() {
  QuadraticSolution solution;
  start();
  for (int exchange = 0; exchange < max_exchanges; ++exchange) {
    const int c = most_violated();
    if (c < 0) break;
    if (!take_up(c)) {
      solution.outcome = QuadraticOutcome::infeasible;
      return solution;
    }
  }
  solution.d = d_;
  solution.multipliers = Multipliers::Zero(m_);
  for (int i = 0; i < active_count_; ++i) {
    const int c = active_[static_cast<std::size_t>(i)];
    if (c < m_) solution.multipliers[c] = std::max(0.0, multipliers_[i]);
  }
  return solution;
}

}  // namespace

bool invert_factor(const SquareMatrix& hessian, SquareMatrix& inverse_factor) {
  const int n = static_cast<int>(hessian.rows());
  SquareMatrix l = hessian;
  for (int j = 0; j < n; ++j) {
    for (int k = 0; k < j; ++k) l.col(j).tail(n - j) -= l(j, k) * l.col(k).tail(n - j);
    const double pivot = l(j, j);
    if (!(pivot > 1e-12 * hessian(j, j)) || !(hessian(j, j) < infinite)) return false;
    l.col(j).tail(n - j) /= std::sqrt(pivot);
  }
  // L⁻ᵀ by backward substitution, column by column: column j has nothing below its diagonal.
  inverse_factor.setZero(n, n);
  for (int j = 0; j < n; ++j) {
    inverse_factor(j, j) = 1 / l(j, j);
    for (int i = j - 1; i >= 0; --i)
      inverse_factor(i, j) =
          -l.col(i).segment(i + 1, j - i).dot(inverse_factor.col(j).segment(i + 1, j - i)) / l(i, i);
  }
  return true;
}

QuadraticSolution solve(const QuadraticProgram& program) { return DualActiveSet(program).run(); }

}  // namespace fude
