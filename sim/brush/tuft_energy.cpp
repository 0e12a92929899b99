#include "sim/brush/tuft_energy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "signal/elementary.h"
#include "sim/brush/section.h"

namespace fude {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

auto index(int i) { return static_cast<std::size_t>(i); }

constexpr double angle_limit_rad = 0.55 * std::numbers::pi;  // of φ and χ: no joint folds back
constexpr double turn_limit_rad = 8 * std::numbers::pi;
constexpr double one_degree_rad = std::numbers::pi / 180;
constexpr double yielding_stiffness = 2;  // mN/mm: keeps the Hessian definite

// (k/m)|x|^m as a function of q = x²; by_q is the derivative.
struct Spring {
  double energy;
  double by_q;
};
Spring spring(double k, double q, double exponent) {
  if (exponent == 2) return {0.5 * k * q, 0.5 * k};
  if (q == 0) return {0, 0};
  const double power = elementary::power(q, 0.5 * exponent);
  return {k / exponent * power, 0.5 * k * power / q};
}

// S over radius and its derivative by the squared bend (Chu 2.5.4 leaves the function open).
struct RestStretch {
  double share;
  double by_bend_squared;
};
RestStretch rest_stretch(const BrushSpec& spec, double submerged, double bend_squared) {
  const double half = spec.spread_half_bend_rad * spec.spread_half_bend_rad;
  const double sum = bend_squared + half;
  return {submerged * (spec.spread_press + spec.spread_bend * bend_squared / sum),
          submerged * spec.spread_bend * half / (sum * sum)};
}

SquareMatrix side_hair_hessian(const Tuft& tuft, const Layout& layout) {
  SquareMatrix h = SquareMatrix::Zero(layout.size(), layout.size());
  for (int side = 0; side < 2; ++side) {
    for (int k = 0; k < tuft.segments; ++k) {
      // Change of slope of the side at node k; hair leaves the ferrule straight, and meets at the tip.
      const double below = 1 / tuft.length_mm[index(k)];
      const double above = k > 0 ? 1 / tuft.length_mm[index(k - 1)] : 0;
      const std::array<double, 3> change = {above, -below - above, below};
      for (int i = -1; i <= 1; ++i) {
        for (int j = -1; j <= 1; ++j) {
          if (k + std::min(i, j) < 1 || k + std::max(i, j) >= tuft.segments) continue;
          h(layout.stretch(k + i, side), layout.stretch(k + j, side)) +=
              tuft.spec.side_hair_stiffness * change[index(i + 1)] * change[index(j + 1)];
        }
      }
    }
  }
  return h;
}

Vector2d level(const Vector3d& v) { return v.head<2>(); }

}  // namespace

double lateral_distance_mm(const Tuft& tuft, const FrozenStep& frozen, int node, double stretch_mm) {
  return tuft.radius_mm[index(node)] - frozen.lateral_radius_mm[index(node)] + stretch_mm;
}

TuftProgram::TuftProgram(const Tuft& tuft, const FrozenStep& frozen)
    : tuft_(tuft), frozen_(frozen), layout_{tuft.segments}, side_hair_(side_hair_hessian(tuft, layout_)) {
  const int n = layout_.size();
  low = Variables::Zero(n);
  high = Variables::Zero(n);
  friction_ = Variables::Zero(n);
  const double per_step = tuft.spec.internal_friction_s / frozen.step_s;
  for (int i = 0; i < tuft.segments; ++i) {
    const double stiffness = tuft.bend_stiffness[index(i)];
    // The root has no twist spring; a trace of friction keeps its turn defined at any step.
    const double floor = i == 0 ? 1e-3 * stiffness : 0;
    friction_[layout_.turn(i)] = tuft.spec.twist_ratio * stiffness * per_step + floor;
    friction_[layout_.bend(i)] = stiffness * per_step;
    friction_[layout_.side_bend(i)] = tuft.spec.side_bend_ratio * stiffness * per_step;
    low[layout_.turn(i)] = -turn_limit_rad;
    high[layout_.turn(i)] = turn_limit_rad;
    for (const int bend : {layout_.bend(i), layout_.side_bend(i)}) {
      low[bend] = -angle_limit_rad;
      high[bend] = angle_limit_rad;
    }
  }
  for (int k = 1; k < tuft.segments; ++k) {
    for (int side = 0; side < 2; ++side) {
      friction_[layout_.stretch(k, side)] = tuft.stretch_stiffness[index(k)] * per_step;
      high[layout_.stretch(k, side)] =
          tuft.spec.spread ? tuft.spec.spread_limit * tuft.radius_mm[index(k)] : 0;
    }
  }
  high[layout_.yielding()] = frozen.plane.stands ? tuft.spec.tuft_length_mm * 20 : 0;

  unit = Variables::Ones(n);
  unit.tail(n - layout_.stretch(1, 0)).setConstant(tuft.spec.belly_radius_mm);
  small_gradient = tuft.bend_stiffness[0] * one_degree_rad;
  small_energy = 0.5 * small_gradient * one_degree_rad;
  small_violation = 1e-7 * tuft.spec.tuft_length_mm;
}

SquareMatrix TuftProgram::spring_hessian() const {
  SquareMatrix h = side_hair_;
  h.diagonal() += friction_;
  for (int i = 0; i < tuft_.segments; ++i) {
    h(layout_.turn(i), layout_.turn(i)) += tuft_.twist_stiffness[index(i)];
    h(layout_.bend(i), layout_.bend(i)) += tuft_.bend_stiffness[index(i)];
    h(layout_.side_bend(i), layout_.side_bend(i)) +=
        tuft_.spec.side_bend_ratio * tuft_.bend_stiffness[index(i)];
  }
  for (int k = 1; k < tuft_.segments; ++k)
    for (int side = 0; side < 2; ++side)
      h(layout_.stretch(k, side), layout_.stretch(k, side)) += tuft_.stretch_stiffness[index(k)];
  h(layout_.yielding(), layout_.yielding()) = yielding_stiffness;
  return h;
}

void TuftProgram::add_bends(const Variables& x, Evaluation& at) const {
  const double m = tuft_.spec.spring_exponent;
  const double across = tuft_.spec.side_bend_ratio;
  for (int i = 0; i < tuft_.segments; ++i) {
    const double f = x[layout_.bend(i)] - frozen_.set_rad[index(i)][0];
    const double c = x[layout_.side_bend(i)] - frozen_.set_rad[index(i)][1];
    const Spring bend = spring(tuft_.bend_stiffness[index(i)], f * f + across * c * c, m);
    const double turn = x[layout_.turn(i)];
    const Spring twist = spring(tuft_.twist_stiffness[index(i)], turn * turn, m);
    at.value += bend.energy + twist.energy;
    at.gradient[layout_.bend(i)] += 2 * bend.by_q * f;
    at.gradient[layout_.side_bend(i)] += 2 * bend.by_q * across * c;
    at.gradient[layout_.turn(i)] += 2 * twist.by_q * turn;
  }
}

void TuftProgram::add_stretches(const Variables& x, Evaluation& at) const {
  if (!tuft_.spec.spread) return;
  for (int k = 1; k < tuft_.segments; ++k) {
    const double f = x[layout_.bend(k)];
    const double c = x[layout_.side_bend(k)];
    const RestStretch rest = rest_stretch(tuft_.spec, frozen_.submerged[index(k)], f * f + c * c);
    const double r = tuft_.radius_mm[index(k)];
    for (int side = 0; side < 2; ++side) {
      const int s = layout_.stretch(k, side);
      const double beyond = x[s] - r * rest.share;
      const Spring stretch =
          spring(tuft_.stretch_stiffness[index(k)], beyond * beyond, tuft_.spec.spring_exponent);
      at.value += stretch.energy;
      const double pull = 2 * stretch.by_q * beyond;
      at.gradient[s] += pull;
      at.gradient[layout_.bend(k)] -= pull * r * rest.by_bend_squared * 2 * f;
      at.gradient[layout_.side_bend(k)] -= pull * r * rest.by_bend_squared * 2 * c;
    }
  }
  const int first = layout_.stretch(1, 0);
  const int count = layout_.yielding() - first;
  const auto stretches = x.segment(first, count);
  const Variables pull = side_hair_.block(first, first, count, count) * stretches;
  at.value += 0.5 * stretches.dot(pull);
  at.gradient.segment(first, count) += pull;
}

void TuftProgram::add_internal_friction(const Variables& x, Evaluation& at) const {
  for (int i = 0; i < layout_.size(); ++i) {
    const double change = x[i] - frozen_.before[i];
    at.value += 0.5 * friction_[i] * change * change;
    at.gradient[i] += friction_[i] * change;
  }
}

void TuftProgram::add_rubbing(const Variables& x, const Skeleton& s, NodeForces& forces,
                              Evaluation& at) const {
  const BrushSpec& spec = tuft_.spec;
  for (int j = 0; j < frozen_.rubbing_count; ++j) {
    const Rubbing& rub = frozen_.rubbing[index(j)];
    const int k = rub.node;
    const double sign = rub.side < 0 ? 0 : rub.side == 0 ? 1 : -1;
    double distance = 0;
    if (rub.side >= 0)
      distance = sign * lateral_distance_mm(tuft_, frozen_, k,
                                            k < tuft_.segments ? x[layout_.stretch(k, rub.side)] : 0);
    const Vector2d slip = level(s.node[index(k)]) + distance * level(s.lateral[index(k)]) - rub.anchor;

    // E = R(√(μ∥² x∥² + μ⊥² x⊥² + μ̄² ε²) − μ̄ ε)
    const double across = spec.friction_across;
    const double along = spec.friction_anisotropy ? spec.friction_along : across;
    const double upright = 1 - rub.along.squaredNorm();
    const double mean = 0.5 * (along + across);
    // Where the hair stands upright it has no direction: the mean takes over.
    const double mu_along = upright * mean + (1 - upright) * along;
    const double mu_across = upright * mean + (1 - upright) * across;
    const double norm = elementary::square_root(rub.along.squaredNorm());
    const Vector2d axis = norm > 0 ? Vector2d(rub.along / norm) : Vector2d(1, 0);
    const double lengthwise = slip.dot(axis);
    const Vector2d crosswise = slip - lengthwise * axis;
    const double rounding = mean * spec.friction_slip_mm;
    const double root = elementary::square_root(mu_along * mu_along * lengthwise * lengthwise +
                                                mu_across * mu_across * crosswise.squaredNorm() +
                                                rounding * rounding + 1e-24);
    at.value += rub.reaction_mn * (root - rounding);
    const Vector2d pull = rub.reaction_mn / root *
                          (mu_along * mu_along * lengthwise * axis + mu_across * mu_across * crosswise);
    forces.at_node[index(k)].head<2>() += pull;
    if (rub.side < 0) continue;
    forces.at_lateral[index(k)].head<2>() += distance * pull;
    if (k < tuft_.segments)
      at.gradient[layout_.stretch(k, rub.side)] += sign * pull.dot(level(s.lateral[index(k)]));
  }
}

TuftProgram::Clearance TuftProgram::clearance(const Variables& x, const Skeleton& s, int k) const {
  const double r = tuft_.radius_mm[index(k)];
  const bool stretches = k < tuft_.segments;
  const Section section =
      section_of(r, stretches ? x[layout_.stretch(k, 0)] : 0, stretches ? x[layout_.stretch(k, 1)] : 0);
  const Reach reach = reach_below(section, s.lateral[index(k)].z());
  const double share = tuft_.contact_share;
  const double minor_by_s = -0.5 * section.minor * section.minor / (r * r);
  return {s.node[index(k)].z() - share * reach.depth, -share * reach.by_lateral_z,
          -share * (reach.by_major_a + reach.by_minor * minor_by_s),
          -share * (reach.by_major_b + reach.by_minor * minor_by_s)};
}

void TuftProgram::fill_constraints(const Variables& x, const Skeleton& s, Evaluation& at) const {
  const int n = tuft_.segments;
  for (int k = 1; k <= n; ++k) {
    const Clearance clear = clearance(x, s, k);
    at.constraints[k - 1] = clear.height;
    add_joint_gradient(s, k, Vector3d::UnitZ(), Vector3d(0, 0, clear.by_lateral_z), at.jacobian.row(k - 1));
    if (k == n) continue;
    at.jacobian(k - 1, layout_.stretch(k, 0)) = clear.by_stretch_a;
    at.jacobian(k - 1, layout_.stretch(k, 1)) = clear.by_stretch_b;
  }
  const BlockingPlane& plane = frozen_.plane;
  if (!plane.stands) {
    at.constraints[n] = tuft_.spec.tuft_length_mm;
    return;
  }
  const double ahead = (level(s.node[index(n)]) - plane.stuck).dot(plane.facing);
  at.constraints[n] = plane.lead_mm + x[layout_.yielding()] - ahead;
  add_joint_gradient(s, n, Vector3d(-plane.facing.x(), -plane.facing.y(), 0), Vector3d::Zero(),
                     at.jacobian.row(n));
  at.jacobian(n, layout_.yielding()) = 1;
}

NodeForces TuftProgram::paper_pull(const Variables& x, const Skeleton& skeleton,
                                   const Multipliers& multipliers) const {
  const int n = tuft_.segments;
  NodeForces forces;
  Evaluation unused;
  unused.gradient.setZero(layout_.size());
  add_rubbing(x, skeleton, forces, unused);
  for (int k = 1; k <= n; ++k) {
    forces.at_node[index(k)].z() -= multipliers[k - 1];
    forces.at_lateral[index(k)].z() -= multipliers[k - 1] * clearance(x, skeleton, k).by_lateral_z;
  }
  if (frozen_.plane.stands) forces.at_node[index(n)].head<2>() += multipliers[n] * frozen_.plane.facing;
  return forces;
}

void TuftProgram::evaluate(const Variables& x, Evaluation& at) const {
  const int n = layout_.size();
  at.value = 0;
  at.gradient.setZero(n);
  at.constraints.resize(constraints());
  at.jacobian.setZero(constraints(), n);
  add_bends(x, at);
  add_stretches(x, at);
  add_internal_friction(x, at);
  const double yielding = x[layout_.yielding()];
  at.value += tuft_.spec.pore_strength_mn * yielding + 0.5 * yielding_stiffness * yielding * yielding;
  at.gradient[layout_.yielding()] += tuft_.spec.pore_strength_mn + yielding_stiffness * yielding;

  const Skeleton skeleton = pose_skeleton(tuft_, x, frozen_.paper_from_handle);
  NodeForces forces;
  add_rubbing(x, skeleton, forces, at);
  add_joint_gradient(skeleton, forces, at.gradient);
  fill_constraints(x, skeleton, at);
}

}  // namespace fude
