#include "calibration/sheet_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
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
  SmoothField bowl = SmoothField::fit(at, z, FreeShape::quadric);
  constexpr std::size_t spare = 6;  // beyond the terms of the polynomial
  if (points.size() < terms(FreeShape::bowed, 2) + spare) return bowl;
  SmoothField bow = SmoothField::fit(at, z, FreeShape::bowed);
  return bow.left_out_residuals().norm() < bowl.left_out_residuals().norm() ? bow : bowl;
}

std::optional<SheetFit> fit_sheet(std::span<const Eigen::Vector3d> points, double finest) {
  if (!spread_out(points)) return std::nullopt;
  SheetFit fit{nearest_to_half(points), std::vector<bool>(points.size(), false)};
  const double few = 1 + 5 / double(points.size() - 6);  // Rousseeuw 1984: a median of few is too small
  for (int round = 0; round < 4; ++round) {
    std::vector<double> distances;
    for (const Eigen::Vector3d& p : points) distances.push_back(std::abs(off(fit.height, p)));
    const double scale = std::max(finest, few * quantile(distances, 0.5) / median_of_one);
    const double allowed = std::max(gate * scale, round == 0 ? bowl_error * depth(fit.height, points) : 0);
    std::vector<bool> agrees(points.size());
    std::vector<Eigen::Vector3d> near;
    for (std::size_t i = 0; i < points.size(); ++i)
      if ((agrees[i] = distances[i] < allowed)) near.push_back(points[i]);
    const bool settled = agrees == fit.agrees;
    fit.agrees = std::move(agrees);
    if (settled) break;
    near = thinned(near);
    if (!spread_out(near)) return std::nullopt;
    fit.height = sheet_through(near);
    const SmoothField plane = SmoothField::polynomial(places(near), heights(near), FreeShape::plane);
    fit.better_than_plane = clearly_smaller(fit.height.left_out_residuals(), plane.left_out_residuals());
    fit.left_out_rms = std::sqrt(fit.height.left_out_residuals().array().square().mean());
  }
  return fit;
}

}  // namespace fude
