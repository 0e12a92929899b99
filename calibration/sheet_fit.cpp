#include "calibration/sheet_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <utility>

#include "calibration/left_out.h"
#include "calibration/report.h"

namespace fude {
namespace {

constexpr double gate = 4;
constexpr double median_of_one = 0.6745;
constexpr double bowl_error = 0.2;  // of its depth: a bowl is only the first guess of a sheet

struct Box {
  Eigen::Vector3d low, size;
  explicit Box(std::span<const Eigen::Vector3d> points) : low(points[0]), size(points[0]) {
    for (const Eigen::Vector3d& p : points) {
      low = low.cwiseMin(p);
      size = size.cwiseMax(p);
    }
    size = (size - low).cwiseMax(1e-300);
  }
  std::pair<int, int> cell(const Eigen::Vector3d& p, int across) const {
    const auto at = [&](int axis) {
      return std::min(across - 1, int(across * (p(axis) - low(axis)) / size(axis)));
    };
    return {at(0), at(1)};
  }
};

bool spread_out(std::span<const Eigen::Vector3d> points) {
  if (points.size() < 12) return false;
  const Box box(points);
  std::array<bool, 9> seen{};
  for (const Eigen::Vector3d& p : points) {
    const auto [x, y] = box.cell(p, 3);
    seen[std::size_t(3 * y + x)] = true;
  }
  return std::count(seen.begin(), seen.end(), true) >= 8;
}

Eigen::MatrixXd places(std::span<const Eigen::Vector3d> points) {
  Eigen::MatrixXd m(Eigen::Index(points.size()), 2);
  for (Eigen::Index i = 0; i < m.rows(); ++i) m.row(i) = points[std::size_t(i)].head<2>();
  return m;
}

Eigen::MatrixXd heights(std::span<const Eigen::Vector3d> points) {
  Eigen::MatrixXd m(Eigen::Index(points.size()), 1);
  for (Eigen::Index i = 0; i < m.rows(); ++i) m(i, 0) = points[std::size_t(i)].z();
  return m;
}

double off(const SmoothField& height, const Eigen::Vector3d& p) {
  return p.z() - height.at(p.head<2>().transpose())(0);
}

// The bowl to which half of the points are nearest, by draws of eight; each draw's points are many enough
// to make up for the noise of one.
SmoothField nearest_to_half(std::span<const Eigen::Vector3d> points) {
  constexpr int draws = 200;
  constexpr std::size_t draw_size = 8, most_judges = 300;
  const std::size_t stride = points.size() / most_judges + 1;
  const auto median = [&](const SmoothField& height) {
    std::vector<double> distances;
    for (std::size_t i = 0; i < points.size(); i += stride)
      distances.push_back(std::abs(off(height, points[i])));
    return quantile(std::move(distances), 0.5);
  };
  SmoothField best = SmoothField::polynomial(places(points), heights(points), FreeShape::quadric);
  double least = median(best);
  std::mt19937 random(1);
  std::vector<Eigen::Vector3d> some(draw_size);
  for (int draw = 0; draw < draws; ++draw) {
    for (Eigen::Vector3d& p : some) p = points[random() % points.size()];
    SmoothField height = SmoothField::polynomial(places(some), heights(some), FreeShape::quadric);
    if (!height.coefficients().allFinite()) continue;
    if (const double half = median(height); half < least) {
      least = half;
      best = std::move(height);
    }
  }
  return best;
}

// From its lowest to its highest, at the points' places.
double depth(const SmoothField& height, std::span<const Eigen::Vector3d> points) {
  double low = 0, high = 0;
  for (const Eigen::Vector3d& p : points) {
    const double z = height.at(p.head<2>().transpose())(0);
    low = std::min(low, z);
    high = std::max(high, z);
  }
  return high - low;
}

// How many different coordinates the points have along an axis, those of one row of a grid being one.
std::size_t lines_across(std::span<const Eigen::Vector3d> points, int axis) {
  constexpr double one_line = 0.05;  // of the extent
  std::vector<double> at;
  for (const Eigen::Vector3d& p : points) at.push_back(p(axis));
  std::sort(at.begin(), at.end());
  const double apart = one_line * (at.back() - at.front());
  std::size_t lines = 1;
  for (double begun = at.front(); const double x : at)
    if (x - begun > apart) {
      ++lines;
      begun = x;
    }
  return lines;
}

SmoothField bowl_through(std::span<const Eigen::Vector3d> points) {
  return SmoothField::fit(places(points), heights(points), FreeShape::quadric);
}

}  // namespace

std::vector<Eigen::Vector3d> thinned(std::span<const Eigen::Vector3d> points) {
  constexpr std::size_t most = 200;
  constexpr int across = 14;
  if (points.size() <= most) return {points.begin(), points.end()};
  const Box box(points);
  std::map<std::pair<int, int>, std::pair<Eigen::Vector3d, int>> cells;
  for (const Eigen::Vector3d& p : points) {
    auto& [sum, count] = cells.try_emplace(box.cell(p, across), Eigen::Vector3d::Zero(), 0).first->second;
    sum += p;
    ++count;
  }
  std::vector<Eigen::Vector3d> means;
  for (const auto& [cell, entry] : cells) means.push_back(entry.first / double(entry.second));
  return means;
}

SmoothField sheet_through(std::span<const Eigen::Vector3d> points) {
  const Eigen::MatrixXd at = places(points), z = heights(points);
  SmoothField bowl = bowl_through(points);
  constexpr std::size_t spare = 6;        // beyond the terms of the polynomial
  constexpr std::size_t for_quartic = 5;  // a fourth power is not told by fewer
  if (points.size() < terms(FreeShape::bowed, 2) + spare || lines_across(points, 0) < for_quartic ||
      lines_across(points, 1) < for_quartic)
    return bowl;
  SmoothField bow = SmoothField::fit(at, z, FreeShape::bowed);
  return bow.left_out_residuals().norm() < bowl.left_out_residuals().norm() ? bow : bowl;
}

namespace {

std::vector<Eigen::Vector3d> chosen(std::span<const Eigen::Vector3d> points,
                                    const std::vector<bool>& agrees) {
  std::vector<Eigen::Vector3d> some;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (agrees[i]) some.push_back(points[i]);
  return some;
}

double scale_of(const std::vector<double>& distances, double finest) {
  // Rousseeuw 1984: a median of few is too small.
  const double few = 1 + 5 / std::max(1.0, double(distances.size()) - 6);
  return std::max(finest, few * quantile(distances, 0.5) / median_of_one);
}

// From the bowl to which half of the points are nearest: whatever lies off it, as of a tip in the air, is
// left out before the sheet bends to it. A sheet with waves it does not find.
std::optional<std::vector<bool>> near_a_bowl(std::span<const Eigen::Vector3d> points, double finest) {
  SmoothField height = nearest_to_half(points);
  std::vector<bool> agrees(points.size(), false);
  for (int round = 0; round < 4; ++round) {
    std::vector<double> distances;
    for (const Eigen::Vector3d& p : points) distances.push_back(std::abs(off(height, p)));
    const double allowed =
        std::max(gate * scale_of(distances, finest), round == 0 ? bowl_error * depth(height, points) : 0);
    std::vector<bool> now(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) now[i] = distances[i] < allowed;
    const bool settled = now == agrees;
    agrees = std::move(now);
    if (settled) break;
    const auto near = thinned(chosen(points, agrees));
    if (!spread_out(near)) return std::nullopt;
    height = sheet_through(near);
  }
  return agrees;
}

// From all points, of which the worst is left out as long as it stands out from the rest by its studentised
// residual: waves stay whole, where few points are bad.
std::vector<bool> without_outliers(std::span<const Eigen::Vector3d> points, double finest) {
  std::vector<bool> agrees(points.size(), true);
  for (std::size_t left = points.size(); 4 * left > 3 * points.size(); --left) {
    const auto used = chosen(points, agrees);
    const SmoothField height = sheet_through(used);
    std::vector<double> residuals;
    for (std::size_t i = 0; i < used.size(); ++i)
      residuals.push_back(
          std::sqrt(std::abs(off(height, used[i]) * height.left_out_residuals()(Eigen::Index(i), 0))));
    const auto worst = std::max_element(residuals.begin(), residuals.end());
    constexpr double stands_out = 6;
    if (*worst < stands_out * scale_of(residuals, finest)) break;
    auto number = worst - residuals.begin();
    for (std::size_t i = 0; i < points.size(); ++i)
      if (agrees[i] && number-- == 0) agrees[i] = false;
  }
  return agrees;
}

// Whether the points that were left out lie side by side, as the crests of a wave do and bad touches do not:
// of the four nearest to each, more than a third are left out too.
bool side_by_side(std::span<const Eigen::Vector3d> points, const std::vector<bool>& agrees) {
  constexpr std::size_t neighbours = 4;
  constexpr double third = 1.0 / 3;
  std::vector<double> shares;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (agrees[i]) continue;
    std::vector<std::pair<double, bool>> near;
    for (std::size_t j = 0; j < points.size(); ++j)
      if (j != i) near.emplace_back((points[i] - points[j]).head<2>().norm(), agrees[j]);
    std::partial_sort(near.begin(), near.begin() + neighbours, near.end());
    const auto out =
        std::count_if(near.begin(), near.begin() + neighbours, [](const auto& n) { return !n.second; });
    shares.push_back(double(out) / neighbours);
  }
  const double sum = std::accumulate(shares.begin(), shares.end(), 0.0);
  return shares.size() > 2 && sum > third * double(shares.size());
}

SheetFit fit_through(std::span<const Eigen::Vector3d> points, std::vector<bool> agrees) {
  const auto used = thinned(chosen(points, agrees));
  SheetFit fit{sheet_through(used), std::move(agrees)};
  const SmoothField plane = SmoothField::polynomial(places(used), heights(used), FreeShape::plane);
  fit.better_than_plane = clearly_smaller(fit.height.left_out_residuals(), plane.left_out_residuals());
  fit.left_out_rms = std::sqrt(fit.height.left_out_residuals().array().square().mean());
  return fit;
}

}  // namespace

std::vector<Strip> left_out_strips(std::span<const Eigen::Vector3d> points) {
  const Box box(points);
  const int across = std::max(3, int(std::sqrt(double(points.size()))));
  std::vector<Strip> strips;
  for (const int axis : {0, 1})
    for (int k = 1; k + 1 < across; ++k) {
      std::vector<Eigen::Vector3d> inside, others;
      for (const Eigen::Vector3d& p : points) {
        const auto [x, y] = box.cell(p, across);
        ((axis == 0 ? x : y) == k ? inside : others).push_back(p);
      }
      if (inside.empty() || others.size() < terms(FreeShape::quadric, 2) + 2) continue;
      const SmoothField height = bowl_through(others);
      std::vector<double> errors;
      Eigen::Vector2d middle = Eigen::Vector2d::Zero();
      for (const Eigen::Vector3d& p : inside) {
        errors.push_back(off(height, p));
        middle += p.head<2>() / double(inside.size());
      }
      strips.push_back({axis, middle, root_mean_square(errors)});
    }
  return strips;
}

std::optional<SheetFit> fit_sheet(std::span<const Eigen::Vector3d> points, double finest) {
  if (!spread_out(points)) return std::nullopt;
  std::optional<SheetFit> bowl;
  if (auto agrees = near_a_bowl(points, finest)) bowl = fit_through(points, std::move(*agrees));
  constexpr std::size_t most_touches = 200;
  if (points.size() > most_touches) return bowl;
  SheetFit all = fit_through(points, without_outliers(points, finest));
  const auto kept = [](const SheetFit& fit) {
    return std::count(fit.agrees.begin(), fit.agrees.end(), true);
  };
  constexpr double as_good = 3;
  const bool whole = bowl && 4 * kept(*bowl) >= 3 * std::ptrdiff_t(points.size());
  if (!whole) return all;
  const bool worse = all.left_out_rms > as_good * bowl->left_out_rms && !side_by_side(points, bowl->agrees);
  return worse || kept(all) <= kept(*bowl) ? bowl : all;
}

}  // namespace fude
