#include "drivers/ultrasonic/multilateration.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace fude::ultrasonic {
namespace {

constexpr double outlier_sigmas = 5;
constexpr double expected_weight = 4;  // measurements that the expected sigma counts for
constexpr double line_share = 1e-3;    // of the longer extent: narrower is a line, or flatter a plane
constexpr std::size_t fewest = 3;

struct Heard {
  Eigen::Vector3d receiver;
  double range_m;
  std::size_t number;
};

struct Solution {
  Eigen::Vector3d position;
  Eigen::Matrix3d normal;  // JᵀJ
  double cost = 0;         // sum of squared residuals
};

double residual(const Heard& heard, const Eigen::Vector3d& position) {
  return heard.range_m - (position - heard.receiver).norm();
}

double cost_of(std::span<const Heard> heard, const Eigen::Vector3d& position) {
  double cost = 0;
  for (const Heard& h : heard) cost += residual(h, position) * residual(h, position);
  return cost;
}

Solution descend(std::span<const Heard> heard, const Eigen::Vector3d& start) {
  Solution s{start, Eigen::Matrix3d::Zero(), cost_of(heard, start)};
  double damping = 1e-3;
  for (int step = 0; step < 60; ++step) {
    s.normal.setZero();
    Eigen::Vector3d slope = Eigen::Vector3d::Zero();
    for (const Heard& h : heard) {
      const Eigen::Vector3d way = s.position - h.receiver;
      const double length = way.norm();
      if (length < 1e-9) continue;  // on the receiver itself no direction is the steepest
      const Eigen::Vector3d direction = way / length;
      s.normal += direction * direction.transpose();
      slope += direction * residual(h, s.position);
    }
    const Eigen::Matrix3d damped = s.normal + damping * Eigen::Matrix3d::Identity();
    const Eigen::Vector3d move = damped.ldlt().solve(slope);
    if (!move.allFinite()) break;
    const double cost = cost_of(heard, s.position + move);
    if (cost <= s.cost) {
      s.position += move;
      s.cost = cost;
      damping = std::max(damping * 0.1, 1e-12);
      if (move.norm() < 1e-10) break;
    } else {
      damping *= 10;
      if (damping > 1e6) break;
    }
  }
  return s;
}

// Extents of the receivers about their middle, largest first, and the direction of the least.
struct Layout {
  Eigen::Vector3d middle;
  Eigen::Vector3d extents;
  Eigen::Vector3d normal;
};

Layout layout_of(std::span<const Heard> heard) {
  Layout layout{Eigen::Vector3d::Zero(), {}, {}};
  for (const Heard& h : heard) layout.middle += h.receiver / static_cast<double>(heard.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Heard& h : heard)
    spread += (h.receiver - layout.middle) * (h.receiver - layout.middle).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(spread);
  layout.extents = axes.eigenvalues().cwiseMax(0).cwiseSqrt().reverse();
  layout.normal = axes.eigenvectors().col(0);
  if (layout.normal.z() < 0) layout.normal = -layout.normal;
  return layout;
}

Solution solve(std::span<const Heard> heard, const std::optional<Eigen::Vector3d>& near) {
  const Layout layout = layout_of(heard);
  double far = 0;
  for (const Heard& h : heard) far += h.range_m / static_cast<double>(heard.size());
  const Solution above = descend(heard, layout.middle + far * layout.normal);
  const Solution below = descend(heard, layout.middle - far * layout.normal);
  // Two places that explain the ranges as well are mirrored: `near` decides, or the greater z.
  const double slack = 0.1 * std::max(above.cost, below.cost) + 1e-12;
  if (above.cost < below.cost - slack) return above;
  if (below.cost < above.cost - slack) return below;
  if (near) return (above.position - *near).norm() <= (below.position - *near).norm() ? above : below;
  return above.position.z() >= below.position.z() ? above : below;
}

double worst_of(std::span<const Heard> heard, const Solution& s) {
  double worst = 0;
  for (const Heard& h : heard) worst = std::max(worst, std::abs(residual(h, s.position)));
  return worst;
}

// The one without which the others agree best and whose way then is too long; none when there is none.
std::optional<std::size_t> echo(const std::vector<Heard>& heard, double tolerance_m,
                                const std::optional<Eigen::Vector3d>& near) {
  std::optional<std::size_t> found;
  double least = 0;
  for (std::size_t i = 0; i < heard.size(); ++i) {
    std::vector<Heard> rest = heard;
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(i));
    if (layout_of(rest).extents[1] < line_share * layout_of(rest).extents[0]) continue;
    const Solution s = solve(rest, near);
    if (residual(heard[i], s.position) < tolerance_m) continue;
    if (!found || s.cost < least) {
      found = i;
      least = s.cost;
    }
  }
  return found;
}

}  // namespace

double speed_of_sound_mps(double temperature_c) {
  return 331.3 * std::sqrt(1 + std::clamp(temperature_c, -50.0, 60.0) / 273.15);
}

Result<Fix> multilaterate(const RangeSample& ranges, const Receivers& receivers,
                          const std::optional<Eigen::Vector3d>& near) {
  const double speed = speed_of_sound_mps(ranges.temperature_c.value_or(receivers.usual_temperature_c));
  const double tolerance_m = outlier_sigmas * receivers.range_sigma_m;
  std::vector<Heard> heard;
  for (std::size_t i = 0; i < std::min(receivers.positions_m.size(), most_receivers); ++i)
    if (ranges.flight_s[i]) heard.push_back({receivers.positions_m[i], *ranges.flight_s[i] * speed, i});
  if (heard.size() < fewest)
    return failure(Fault::malformed, "only " + std::to_string(heard.size()) +
                                         " receivers heard the pulse; a position takes three");
  const Layout layout = layout_of(heard);
  if (layout.extents[1] < line_share * layout.extents[0])
    return failure(Fault::malformed,
                   "the receivers that heard the pulse stand in one line; move one of them");

  Solution solution = solve(heard, near);
  while (worst_of(heard, solution) > tolerance_m && heard.size() > fewest + 1) {
    const auto late = echo(heard, tolerance_m, near);
    if (!late) break;
    heard.erase(heard.begin() + static_cast<std::ptrdiff_t>(*late));
    solution = solve(heard, near);
  }
  if (worst_of(heard, solution) > tolerance_m)
    return failure(Fault::malformed, "the ranges contradict each other: an echo, or a receiver was moved");

  // Where the emitter lies in the plane of all receivers no range changes when it leaves the plane.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(solution.normal);
  if (!(axes.eigenvalues()[0] > 1e-4 * axes.eigenvalues()[2]))
    return failure(Fault::malformed, "the emitter lies in the plane of the receivers; raise one of them");

  const double degrees_of_freedom = static_cast<double>(heard.size() - fewest);
  const double spread =
      (expected_weight * receivers.range_sigma_m * receivers.range_sigma_m + solution.cost) /
      (expected_weight + degrees_of_freedom);
  Fix fix;
  fix.position_m = solution.position;
  fix.covariance_m2 = spread * solution.normal.inverse();
  fix.residual_m = std::sqrt(solution.cost / static_cast<double>(heard.size()));
  for (const Heard& h : heard) fix.receivers |= 1u << h.number;
  return fix;
}

PositionSample position_of(const RangeSample& ranges, const Receivers& receivers,
                           const std::optional<Eigen::Vector3d>& near) {
  PositionSample sample;
  sample.time = ranges.time;
  sample.marker = "emitter";
  sample.after_gap = ranges.after_gap;
  if (const auto fix = multilaterate(ranges, receivers, near)) {
    sample.tracker_from_marker_m = fix->position_m;
    sample.covariance_m2 = fix->covariance_m2;
    sample.residual_m = fix->residual_m;
  } else {
    sample.valid = false;
  }
  return sample;
}

}  // namespace fude::ultrasonic
