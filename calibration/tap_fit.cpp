#include "calibration/tap_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>

#include "calibration/left_out.h"

namespace fude {
namespace {

constexpr int homography_terms = 8;
constexpr std::size_t fewest_for_warp = 12;
constexpr double least_lean = 0.05;  // standard deviation of the tangents: 3 degrees
constexpr double chance = 1e-3;

using Unknowns = Eigen::VectorXd;

// Counts to the square of about ±1 and back: the equations are then of one size.
struct Scaling {
  Eigen::Vector2d middle, half;
  explicit Scaling(std::span<const Tap> taps) {
    Eigen::Vector2d low = taps[0].counts, high = low;
    for (const Tap& tap : taps) {
      low = low.cwiseMin(tap.counts);
      high = high.cwiseMax(tap.counts);
    }
    middle = 0.5 * (low + high);
    half = (0.5 * (high - low)).cwiseMax(1e-9);
  }
  Eigen::Vector2d operator()(const Eigen::Vector2d& counts) const {
    return (counts - middle).cwiseQuotient(half);
  }
};

// Eight numbers of the homography, row by row without the last, then the lean's two in halves of the square.
struct Equation {
  Eigen::Vector2d place;
  Eigen::Matrix<double, 2, homography_terms + 2> slope;
  double depth = 1;
};

Equation equation(const Tap& tap, const Scaling& scaling, const Unknowns& h) {
  const Eigen::Vector2d lean = h.tail<2>();
  const Eigen::Vector2d u = scaling(tap.counts) + lean.cwiseProduct(tap.lean);
  Equation e;
  e.depth = h(6) * u.x() + h(7) * u.y() + 1;
  const Eigen::RowVector3d row(u.x(), u.y(), 1);
  e.place = Eigen::Vector2d(row.dot(h.segment<3>(0)), row.dot(h.segment<3>(3))) / e.depth;
  e.slope.setZero();
  for (int axis = 0; axis < 2; ++axis) {
    e.slope.block<1, 3>(axis, 3 * axis) = row / e.depth;
    e.slope.block<1, 2>(axis, 6) = -e.place(axis) * u.transpose() / e.depth;
    for (int k = 0; k < 2; ++k)
      e.slope(axis, 8 + k) = (h(3 * axis + k) - e.place(axis) * h(6 + k)) / e.depth * tap.lean(k);
  }
  return e;
}

// Gauss and Newton from the affine map, which is the first step from no perspective.
Unknowns solve(std::span<const Tap> taps, const std::vector<Eigen::Vector2d>& places, const Scaling& scaling,
               bool lean) {
  const auto n = Eigen::Index(taps.size());
  Unknowns h = Unknowns::Zero(homography_terms + 2);
  for (const Eigen::Index terms : {Eigen::Index(6), Eigen::Index(8), Eigen::Index(8), Eigen::Index(8)}) {
    std::vector<Eigen::Index> sought;
    for (Eigen::Index i = 0; i < terms; ++i) sought.push_back(i);
    if (lean && terms == homography_terms) sought.insert(sought.end(), {8, 9});
    Eigen::MatrixXd slopes(2 * n, Eigen::Index(sought.size()));
    Eigen::VectorXd missing(2 * n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const Equation e = equation(taps[std::size_t(i)], scaling, h);
      missing.segment<2>(2 * i) = places[std::size_t(i)] - e.place;
      for (std::size_t k = 0; k < sought.size(); ++k)
        slopes.block<2, 1>(2 * i, Eigen::Index(k)) = e.slope.col(sought[k]);
    }
    const Eigen::VectorXd step = slopes.colPivHouseholderQr().solve(missing);
    Unknowns next = h;
    for (std::size_t k = 0; k < sought.size(); ++k) next(sought[k]) += step(Eigen::Index(k));
    constexpr double steepest = 0.5;  // at the edge: no tablet is seen so obliquely
    if (!next.allFinite() || std::abs(next(6)) + std::abs(next(7)) > steepest) break;
    h = next;
  }
  return h;
}

TabletSurface surface_of(const Unknowns& h, const Scaling& scaling) {
  Eigen::Matrix3d unit;
  unit << h(0), h(1), h(2), h(3), h(4), h(5), h(6), h(7), 1;
  Eigen::Matrix3d to_unit = Eigen::Matrix3d::Identity();
  for (int axis = 0; axis < 2; ++axis) {
    to_unit(axis, axis) = 1 / scaling.half(axis);
    to_unit(axis, 2) = -scaling.middle(axis) / scaling.half(axis);
  }
  TabletSurface surface;
  surface.mm_from_counts = unit * to_unit;
  surface.lean_counts = h.tail<2>().cwiseProduct(scaling.half);
  return surface;
}

// Of the shapes that bend for nothing and that do not, the one that foretells better.
SmoothField smooth_warp(const Eigen::MatrixXd& at, const Eigen::MatrixXd& rest) {
  SmoothField stiff = SmoothField::fit(at, rest, FreeShape::plane);
  SmoothField bowl = SmoothField::fit(at, rest, FreeShape::quadric);
  return bowl.left_out_residuals().norm() < stiff.left_out_residuals().norm() ? bowl : stiff;
}

std::vector<Tap> without(std::span<const Tap> taps, std::size_t left) {
  std::vector<Tap> others(taps.begin(), taps.end());
  others.erase(others.begin() + std::ptrdiff_t(left));
  return others;
}

bool leans(std::span<const Tap> taps) {
  for (int axis = 0; axis < 2; ++axis) {
    double sum = 0, squares = 0;
    for (const Tap& tap : taps) {
      sum += tap.lean(axis);
      squares += tap.lean(axis) * tap.lean(axis);
    }
    const double n = double(taps.size());
    if (std::sqrt(std::max(0.0, squares / n - sum * sum / (n * n))) < least_lean) return false;
  }
  return true;
}

struct Choice {
  TapModel model;
  Eigen::MatrixXd left_out;
};

// Lean before warp, and once more after it: what bends may hide what leans.
Choice choose_model(std::span<const Tap> taps) {
  Choice best{{}, left_out_errors(taps, {})};
  const auto consider = [&](TapModel model) {
    Eigen::MatrixXd errors = left_out_errors(taps, model);
    if (clearly_smaller(errors, best.left_out)) best = {model, std::move(errors)};
  };
  const bool may_lean = leans(taps);
  if (may_lean) consider({.lean = true});
  if (taps.size() >= fewest_for_warp) consider({.lean = best.model.lean, .warp = true});
  if (may_lean && !best.model.lean && best.model.warp) consider({.lean = true, .warp = true});
  return best;
}

// The tap without which the squares are least, where chance does not explain it: of the mean square that it
// takes away over that which stays, P(F > f) = (1 + 2f/d)^(−d/2) with 2 and d degrees of freedom, and n taps
// had the chance.
std::optional<std::size_t> worst_tap(std::span<const Tap> taps, TapModel model) {
  const double all = fit_taps(taps, model).sum_mm2;
  std::size_t worst = 0;
  TapFit least{.sum_mm2 = all};
  for (std::size_t i = 0; i < taps.size(); ++i)
    if (TapFit fit = fit_taps(without(taps, i), model); fit.sum_mm2 < least.sum_mm2) {
      worst = i;
      least = std::move(fit);
    }
  const double d = 2 * double(taps.size() - 1) - least.freedom;
  if (d < 1 || !(least.sum_mm2 < all)) return std::nullopt;
  const double f = (all - least.sum_mm2) / 2 / std::max(least.sum_mm2 / d, 1e-12);
  const double by_chance = double(taps.size()) * std::pow(1 + 2 * f / d, -d / 2);
  return by_chance < chance ? std::optional(worst) : std::nullopt;
}

}  // namespace

TapFit fit_taps(std::span<const Tap> taps, TapModel model) {
  const Scaling scaling(taps);
  const auto n = Eigen::Index(taps.size());
  std::vector<Eigen::Vector2d> places;
  for (const Tap& tap : taps) places.push_back(tap.place_mm);
  TapFit fit;
  // What the warp explains is taken from the places and the rest fitted again, until both agree.
  const int rounds = model.warp ? 4 : 1;
  for (int round = 0; round < rounds; ++round) {
    const std::optional<SmoothField> warp = std::exchange(fit.surface.warp, std::nullopt);
    for (std::size_t i = 0; warp && i < taps.size(); ++i) {
      const Eigen::RowVector2d flat = (on_paper(fit.surface, taps[i].counts, taps[i].lean)).transpose();
      places[i] = taps[i].place_mm - warp->at(flat).transpose();
    }
    fit.surface = surface_of(solve(taps, places, scaling, model.lean), scaling);
    if (!model.warp) continue;
    Eigen::MatrixXd at(n, 2), rest(n, 2);
    for (Eigen::Index i = 0; i < n; ++i) {
      const Tap& tap = taps[std::size_t(i)];
      at.row(i) = on_paper(fit.surface, tap.counts, tap.lean).transpose();
      rest.row(i) = tap.place_mm.transpose() - at.row(i);
    }
    fit.surface.warp = smooth_warp(at, rest);
  }
  for (const Tap& tap : taps)
    fit.sum_mm2 += (tap.place_mm - on_paper(fit.surface, tap.counts, tap.lean)).squaredNorm();
  const double planes = 3;
  fit.freedom = homography_terms + (model.lean ? 2 : 0) +
                (fit.surface.warp ? 2 * (fit.surface.warp->freedom() - planes) : 0);
  return fit;
}

Eigen::MatrixXd left_out_errors(std::span<const Tap> taps, TapModel model) {
  Eigen::MatrixXd errors(Eigen::Index(taps.size()), 2);
  for (std::size_t i = 0; i < taps.size(); ++i) {
    const TabletSurface surface = fit_taps(without(taps, i), model).surface;
    errors.row(Eigen::Index(i)) =
        (taps[i].place_mm - on_paper(surface, taps[i].counts, taps[i].lean)).transpose();
  }
  return errors;
}

RobustTaps robust_taps(std::span<const Tap> taps) {
  RobustTaps robust;
  robust.agrees.assign(taps.size(), true);
  robust.used.assign(taps.begin(), taps.end());
  std::vector<std::size_t> numbers(taps.size());
  for (std::size_t i = 0; i < taps.size(); ++i) numbers[i] = i;
  const auto leave_out_the_bad = [&](TapModel model) {
    while (4 * robust.used.size() > 3 * taps.size()) {
      const auto worst = worst_tap(robust.used, model);
      if (!worst) return;
      robust.agrees[numbers[*worst]] = false;
      robust.used = without(robust.used, *worst);
      numbers.erase(numbers.begin() + std::ptrdiff_t(*worst));
    }
  };
  robust.leaned = leans(taps);
  leave_out_the_bad({.lean = robust.leaned});
  Choice choice = choose_model(robust.used);
  if (choice.model.warp) {
    leave_out_the_bad(choice.model);
    choice = choose_model(robust.used);
  }
  robust.model = choice.model;
  robust.left_out = std::move(choice.left_out);
  robust.fit = fit_taps(robust.used, robust.model);
  return robust;
}

}  // namespace fude
