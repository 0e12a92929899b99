#include "drivers/falcon/kinematics.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "signal/elementary.h"

namespace fude::falcon {
namespace {

// Lengths in metres, named as in Stamper's figure of a leg.
constexpr double a = 0.060;     // thigh
constexpr double b = 0.1025;    // long side of the shin's parallelogram
constexpr double c = 0.01443;   // from the shin to the middle of the grip, along the leg
constexpr double d = 0.01125;   // from the shin to its joint at the grip
constexpr double e = 0.01125;   // and at the knee
constexpr double f = -0.025;    // from the shin to the middle of the grip, across the leg
constexpr double r = 0.040;     // from the middle of the base to the leg, along it
constexpr double s = -0.02309;  // and across it
constexpr double degree = std::numbers::pi / 180;
constexpr std::array<double, 3> leg_directions{(90 + 15) * degree, (-30 + 15) * degree, (-150 + 15) * degree};

// The encoder wheel has 320 slots, four edges each; its shaft drives the drum of the leg by a cable.
constexpr double degrees_per_count = 0.01425 / 0.110 * 360 / (320 * 4);
constexpr double degrees_at_zero = 35;

// A position as one leg sees it: U along it from the knee's plane, V across, W before the base.
struct LegView {
  double u, v, w;
  double reach;  // projected length of the shin, with its joints
  double depth;  // b sin θ3
};

Eigen::Matrix3d to_leg(std::size_t leg) {
  const auto turn = elementary::sine_cosine(leg_directions[leg]);
  Eigen::Matrix3d rotation;
  rotation << turn.cosine, turn.sine, 0, -turn.sine, turn.cosine, 0, 0, 0, 1;
  return rotation;
}

std::optional<LegView> view(std::size_t leg, const Eigen::Vector3d& position) {
  const Eigen::Vector3d local = to_leg(leg) * position;
  LegView seen{local.x() - r + c, local.y() - s + f, local.z(), 0, 0};
  const double square = b * b - seen.v * seen.v;
  if (!(square > 1e-8)) return std::nullopt;
  seen.depth = std::sqrt(square);
  seen.reach = seen.depth + d + e;
  return seen;
}

std::optional<double> thigh_angle(const LegView& seen) {
  const double far = std::sqrt(seen.u * seen.u + seen.w * seen.w);
  if (far < 1e-6) return std::nullopt;
  const double share = (far * far + a * a - seen.reach * seen.reach) / (2 * a * far);
  if (!(std::abs(share) < 1)) return std::nullopt;
  return elementary::arctangent(seen.w, seen.u) - elementary::arccosine(share);
}

// What a leg's closing condition (u - a cos θ)² + (w - a sin θ)² = reach² changes by, halved: along x, y, z
// of the base, and with θ.
struct Slopes {
  Eigen::Vector3d position;
  double angle;
  double error;
};

Slopes slopes(std::size_t leg, const LegView& seen, double angle) {
  const auto thigh = elementary::sine_cosine(angle);
  const double u = seen.u - a * thigh.cosine;
  const double w = seen.w - a * thigh.sine;
  const Eigen::Vector3d local(u, seen.reach * seen.v / seen.depth, w);
  return {to_leg(leg).transpose() * local, a * (seen.u * thigh.sine - seen.w * thigh.cosine),
          (u * u + w * w - seen.reach * seen.reach) / 2};
}

}  // namespace

double leg_angle(std::int16_t encoder_counts) {
  return (encoder_counts * degrees_per_count + degrees_at_zero) * degree;
}

std::optional<Eigen::Vector3d> leg_angles(const Eigen::Vector3d& position_m) {
  Eigen::Vector3d angles;
  for (std::size_t leg = 0; leg < 3; ++leg) {
    const auto seen = view(leg, position_m);
    const auto angle = seen ? thigh_angle(*seen) : std::nullopt;
    if (!angle) return std::nullopt;
    angles[static_cast<Eigen::Index>(leg)] = *angle;
  }
  return angles;
}

// Newton's method on the three closing conditions; a step is held to 2 cm, so that it stays on its branch.
std::optional<Eigen::Vector3d> grip_position(const Eigen::Vector3d& leg_angles_rad,
                                             const Eigen::Vector3d& near) {
  if (!leg_angles_rad.allFinite() || leg_angles_rad.cwiseAbs().maxCoeff() > 4) return std::nullopt;
  Eigen::Vector3d position = near;
  for (int step = 0; step < 30; ++step) {
    Eigen::Matrix3d matrix;
    Eigen::Vector3d errors;
    for (std::size_t leg = 0; leg < 3; ++leg) {
      const auto seen = view(leg, position);
      if (!seen) return std::nullopt;
      const auto i = static_cast<Eigen::Index>(leg);
      const Slopes at = slopes(leg, *seen, leg_angles_rad[i]);
      matrix.row(i) = at.position.transpose();
      errors[i] = at.error;
    }
    if (!(std::abs(matrix.determinant()) > 1e-9)) return std::nullopt;
    Eigen::Vector3d move = matrix.partialPivLu().solve(-errors);
    const double length = move.norm();
    if (!std::isfinite(length)) return std::nullopt;
    if (length > 0.02) move *= 0.02 / length;
    position += move;
    if (length < 1e-12) break;
    if (step == 29 && length > 1e-7) return std::nullopt;
  }
  if (!(position.z() > 0)) return std::nullopt;
  // Another assembly of the legs may have the same angles' sines: only this one gives them back.
  const auto back = leg_angles(position);
  if (!back || (*back - leg_angles_rad).cwiseAbs().maxCoeff() > 1e-6) return std::nullopt;
  return position;
}

std::optional<Eigen::Matrix3d> angle_jacobian(const Eigen::Vector3d& position_m) {
  const auto angles = leg_angles(position_m);
  if (!angles) return std::nullopt;
  Eigen::Matrix3d jacobian;
  for (std::size_t leg = 0; leg < 3; ++leg) {
    const auto i = static_cast<Eigen::Index>(leg);
    const Slopes at = slopes(leg, *view(leg, position_m), (*angles)[i]);
    if (!(std::abs(at.angle) > 1e-6)) return std::nullopt;
    jacobian.row(i) = -at.position.transpose() / at.angle;
  }
  return jacobian;
}

std::optional<Eigen::Vector3d> leg_torques(const Eigen::Vector3d& position_m,
                                           const Eigen::Vector3d& force_n) {
  const auto jacobian = angle_jacobian(position_m);
  if (!jacobian || !(std::abs(jacobian->determinant()) > 1.0)) return std::nullopt;
  const Eigen::Vector3d torques = jacobian->transpose().partialPivLu().solve(force_n);
  if (!torques.allFinite()) return std::nullopt;
  return torques;
}

std::optional<Eigen::Vector3d> grip_force(const Eigen::Vector3d& position_m,
                                          const Eigen::Vector3d& torques_nm) {
  const auto jacobian = angle_jacobian(position_m);
  if (!jacobian) return std::nullopt;
  return jacobian->transpose() * torques_nm;
}

}  // namespace fude::falcon
