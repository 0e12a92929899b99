#include "sim/brush/tuft_step.h"

#include <algorithm>
#include <cmath>

#include "signal/elementary.h"
#include "sim/brush/contact_force.h"
#include "sim/brush/section.h"
#include "sim/brush/sqp.h"

namespace fude {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

auto index(int i) { return static_cast<std::size_t>(i); }

constexpr double shortest_step_s = 1e-4;
constexpr double longest_step_s = 0.5;
constexpr double upright_sine = 0.02;  // within about 1° of upright
constexpr double straight_rad = 0.02;  // total bend of a tuft that counts as straight
constexpr double nudge_rad = 0.03;     // first bend of an upright tuft that is pressed
constexpr double anchor_slack = 3;     // times epsilon: 95 % of the full friction

Vector2d level(const Vector3d& v) { return v.head<2>(); }

Section section_at(const Tuft& tuft, const Variables& x, int k) {
  const Layout layout{tuft.segments};
  const bool between = k > 0 && k < tuft.segments;
  return section_of(tuft.radius_mm[index(k)], between ? x[layout.stretch(k, 0)] : 0,
                    between ? x[layout.stretch(k, 1)] : 0);
}

double total_bend(const Tuft& tuft, const Variables& x) {
  const Layout layout{tuft.segments};
  double sum = 0;
  for (int i = 0; i < tuft.segments; ++i)
    sum += std::abs(x[layout.bend(i)]) + std::abs(x[layout.side_bend(i)]);
  return sum;
}

// Turns every lateral line by `angle` about the spine and leaves the spine where it is.
void roll(const Tuft& tuft, TuftState& state, double angle) {
  const Layout layout{tuft.segments};
  const auto [sine, cosine] = elementary::sine_cosine(angle);
  state.x[layout.turn(0)] += angle;
  for (int i = 0; i < tuft.segments; ++i) {
    const double f = state.x[layout.bend(i)];
    const double c = state.x[layout.side_bend(i)];
    state.x[layout.bend(i)] = cosine * f + sine * c;
    state.x[layout.side_bend(i)] = cosine * c - sine * f;
    const Vector2d set = state.set_rad[index(i)];
    state.set_rad[index(i)] = {cosine * set[0] + sine * set[1], cosine * set[1] - sine * set[0]};
  }
}

// At first contact the lateral lines are made level (Chu 2.5.8); of an upright tuft, square to the
// way the hand moves; else they stay.
void level_lateral_lines(const Tuft& tuft, TuftState& state, const Skeleton& skeleton,
                         const Vector2d& motion) {
  const Vector3d along = skeleton.along[0];
  const Vector3d lateral = skeleton.lateral[1];
  Vector3d wanted = along.cross(Vector3d::UnitZ());
  const bool upright = wanted.norm() < upright_sine;
  if (upright) {
    if (motion.norm() < 1e-3) return;
    wanted = Vector3d(-motion.y(), motion.x(), 0);
  }
  wanted -= along * along.dot(wanted);
  if (wanted.norm() == 0) return;
  wanted.normalize();
  // Both ways round are level; an upright tuft must bend with its tip trailing.
  if (!upright && wanted.dot(lateral) < 0) wanted = -wanted;
  const double angle = elementary::arctangent(lateral.cross(wanted).dot(-along), lateral.dot(wanted));
  roll(tuft, state, angle);
}

void freeze_rubbing(const Tuft& tuft, TuftState& state, const Skeleton& skeleton, FrozenStep& frozen) {
  const Layout layout{tuft.segments};
  for (int k = 1; k <= tuft.segments; ++k) {
    const double share_of_spine = k < tuft.segments ? 0.5 : 1;
    const double reaction = state.reactions[k - 1] + tuft.spec.adhesion_mn * state.submerged[index(k)];
    const int first = frozen.rubbing_count;
    double shares = 0;
    for (int side = -1; side < (k < tuft.segments ? 2 : 0); ++side) {
      const double sign = side < 0 ? 0 : side == 0 ? 1 : -1;
      const double distance =
          side < 0 ? 0 : sign * lateral_distance_mm(tuft, frozen, k, state.x[layout.stretch(k, side)]);
      const Vector3d point = skeleton.node[index(k)] + distance * skeleton.lateral[index(k)];
      const double radius = side < 0 ? state.minor_mm[index(k)] : frozen.lateral_radius_mm[index(k)];
      Touch& touch = state.touches[index(k)][index(side + 1)];
      const bool touching = point.z() - radius < 0;
      if (touching && !touch.touching) touch.anchor = level(point);
      touch.touching = touching;
      if (!touching) continue;
      const double share = side < 0 ? share_of_spine : 0.5 * (1 - share_of_spine);
      shares += share;
      frozen.rubbing[index(frozen.rubbing_count++)] = {k, side, share * reaction, touch.anchor,
                                                       level(skeleton.along[index(k - 1)])};
    }
    for (int j = first; j < frozen.rubbing_count; ++j) frozen.rubbing[index(j)].reaction_mn /= shares;
  }
}

void let_go(TuftState& state) {
  for (auto& sides : state.touches)
    for (Touch& touch : sides) touch.touching = false;
  state.plane.stands = false;
}

// Anchors follow a slipping point so that it stays on the flat part of its friction.
void drag_anchors(const Tuft& tuft, TuftState& state, const FrozenStep& frozen, const Skeleton& skeleton) {
  const Layout layout{tuft.segments};
  const double slack = anchor_slack * tuft.spec.friction_slip_mm;
  for (int j = 0; j < frozen.rubbing_count; ++j) {
    const Rubbing& rub = frozen.rubbing[index(j)];
    const double sign = rub.side < 0 ? 0 : rub.side == 0 ? 1 : -1;
    const double distance =
        rub.side < 0
            ? 0
            : sign * lateral_distance_mm(tuft, frozen, rub.node, state.x[layout.stretch(rub.node, rub.side)]);
    const Vector2d point =
        level(skeleton.node[index(rub.node)]) + distance * level(skeleton.lateral[index(rub.node)]);
    Touch& touch = state.touches[index(rub.node)][index(rub.side + 1)];
    const Vector2d slip = point - touch.anchor;
    const double length = slip.norm();
    if (length > slack) touch.anchor = point - slip * (slack / length);
  }
}

// The plane stands where the tip stuck: it moves back with the tip, sideways with it, and forward
// only when it yields (Chu 2.5.6, in place instead of per frame).
void move_plane(const Tuft& tuft, TuftState& state, const Skeleton& skeleton) {
  const int n = tuft.segments;
  BlockingPlane& plane = state.plane;
  const Vector3d tip_along = skeleton.along[index(n - 1)];
  const double tilt_sine = level(tip_along).norm();
  const bool touching = state.touches[index(n)][0].touching && tip_along.z() < 0;
  if (!tuft.spec.pore_resistance || !touching || tilt_sine < upright_sine) {
    plane.stands = false;
    return;
  }
  const Vector2d tip = level(skeleton.node[index(n)]);
  const double ahead = plane.stands ? (tip - plane.stuck).dot(plane.facing) : 0;
  const double yielded = plane.stands ? state.x[Layout{n}.yielding()] : 0;
  plane.facing = level(tip_along) / tilt_sine;
  plane.stuck = tip - std::max(0.0, ahead - yielded) * plane.facing;
  plane.stands = true;
  const double tilt = elementary::arccosine(std::clamp(-tip_along.z(), -1.0, 1.0));
  const BrushSpec& spec = tuft.spec;
  plane.lead_mm = spec.pore_lead_mm +
                  spec.pore_tilt_lead_mm * std::max(0.0, tilt - spec.pore_critical_tilt_rad) +
                  spec.pore_pressure_lead_mm * state.reactions[n - 1];
}

void settle(const Tuft& tuft, TuftState& state, const FrozenStep& frozen, const Multipliers& reactions) {
  // Taken over at once, contact would hop between neighbouring nodes from step to step.
  const double follow = tuft.spec.reaction_lag_s > 0
                            ? 1 - elementary::exponential(-frozen.step_s / tuft.spec.reaction_lag_s)
                            : 1;
  state.reactions += follow * (reactions - state.reactions);
  const Skeleton skeleton = pose_skeleton(tuft, state.x, frozen.paper_from_handle);
  const Layout layout{tuft.segments};
  state.in_contact = false;
  for (int k = 1; k <= tuft.segments; ++k) {
    const Section section = section_at(tuft, state.x, k);
    const double reach = reach_below(section, skeleton.lateral[index(k)].z()).depth;
    const double shrunk = tuft.contact_share * reach;
    state.minor_mm[index(k)] = section.minor;
    state.submerged[index(k)] =
        std::clamp((reach - skeleton.node[index(k)].z()) / (reach - shrunk), 0.0, 1.0);
    if (state.submerged[index(k)] > 0) state.in_contact = true;
  }
  drag_anchors(tuft, state, frozen, skeleton);
  move_plane(tuft, state, skeleton);
  if (!tuft.spec.plasticity) {
    state.set_rad.fill(Vector2d::Zero());
    return;
  }
  const double share = 1 - elementary::exponential(-tuft.spec.plasticity_rate_per_s * frozen.step_s);
  for (int i = 0; i < tuft.segments; ++i) {
    Vector2d bend(state.x[layout.bend(i)], state.x[layout.side_bend(i)]);
    const double size = bend.norm();
    if (size > tuft.spec.plasticity_rad) bend *= tuft.spec.plasticity_rad / size;
    state.set_rad[index(i)] += share * (bend - state.set_rad[index(i)]);
  }
}

}  // namespace

TuftState rest_state(const Tuft& tuft) {
  TuftState state;
  const Layout layout{tuft.segments};
  state.x = Variables::Zero(layout.size());
  state.hessian.resize(0, 0);
  state.reactions = Multipliers::Zero(tuft.segments + 1);
  state.minor_mm = tuft.radius_mm;
  return state;
}

Pose<Paper, Handle> reachable_pose(const Tuft& tuft, Pose<Paper, Handle> pose) {
  const double lowest = tuft.spec.lowest_root * tuft.spec.tuft_length_mm;
  pose.translation.z() = std::max(pose.translation.z(), lowest);
  return pose;
}

Bends bends_of(const Tuft& tuft, const TuftState& state) {
  const Layout layout{tuft.segments};
  Bends bends;
  bends.fill(Vector2d::Zero());
  for (int i = 0; i < tuft.segments; ++i)
    bends[index(i)] = {state.x[layout.bend(i)], state.x[layout.side_bend(i)]};
  return bends;
}

FrozenStep freeze_step(const Tuft& tuft, TuftState& state, const Pose<Paper, Handle>& pose, double step_s,
                       const Bends* beside) {
  FrozenStep frozen;
  frozen.paper_from_handle = pose;
  frozen.step_s = step_s;
  Skeleton skeleton = pose_skeleton(tuft, state.x, pose);
  const Vector2d motion = state.placed ? level(pose.translation - state.paper_from_handle.translation)
                                       : Vector2d(Vector2d::Zero());
  bool touches = false;
  bool presses = false;
  for (int k = 1; k <= tuft.segments; ++k) {
    touches = touches || skeleton.node[index(k)].z() < state.minor_mm[index(k)];
    presses = presses || skeleton.node[index(k)].z() < tuft.contact_share * state.minor_mm[index(k)];
  }
  if (touches && !state.in_contact && tuft.spec.spines == 1) {
    level_lateral_lines(tuft, state, skeleton, motion);
    skeleton = pose_skeleton(tuft, state.x, pose);
  }
  // Straight and upright, pressing has no way to go: a first bend gives it one.
  if (presses && total_bend(tuft, state.x) < straight_rad && level(skeleton.along[0]).norm() < upright_sine) {
    for (int i = 0; i < tuft.segments; ++i) state.x[Layout{tuft.segments}.bend(i)] += nudge_rad;
    skeleton = pose_skeleton(tuft, state.x, pose);
  }
  state.x[Layout{tuft.segments}.yielding()] = 0;
  frozen.before = state.x;
  frozen.set_rad = state.set_rad;
  if (tuft.spec.spines > 1) {
    // Two quadratic springs on one joint are one, stiffer, to a place between them.
    const double w = tuft.spec.row_coherence;
    const Bends neighbours = beside ? *beside : bends_of(tuft, state);
    for (int i = 0; i < tuft.segments; ++i)
      frozen.set_rad[index(i)] = (state.set_rad[index(i)] + w * neighbours[index(i)]) / (1 + w);
  }
  frozen.submerged = state.submerged;
  frozen.plane = state.plane;
  for (int k = 0; k <= tuft.segments; ++k)
    frozen.lateral_radius_mm[index(k)] = tuft.spec.lateral_share * state.minor_mm[index(k)];
  freeze_rubbing(tuft, state, skeleton, frozen);
  return frozen;
}

SolveReport advance(const Tuft& tuft, TuftState& state, const Pose<Paper, Handle>& paper_from_handle,
                    double step_s, bool jumped, ContactModel* model, const Bends* beside) {
  step_s = std::clamp(step_s, shortest_step_s, longest_step_s);
  if (jumped) let_go(state);
  const bool was_in_contact = state.in_contact;
  const Pose<Paper, Handle> pose = reachable_pose(tuft, paper_from_handle);
  const FrozenStep frozen = freeze_step(tuft, state, pose, step_s, beside);
  const TuftProgram program(tuft, frozen);
  const SquareMatrix fresh = program.spring_hessian();
  if (!was_in_contact || state.hessian.rows() != fresh.rows()) {
    state.hessian = fresh;
  } else if (state.hessian_step_s != step_s) {
    state.hessian.diagonal() += program.friction_hessian() * (1 - step_s / state.hessian_step_s);
  }
  state.hessian_step_s = step_s;

  SqpLimits limits;
  limits.iterations = static_cast<int>(tuft.spec.iteration_limit);
  const SqpResult solved = minimise(program, state.x, state.hessian, fresh, limits);
  if (!state.x.allFinite() || !std::isfinite(solved.value)) {
    // Nothing a hand can do leads here; a tuft at rest is the only state left that means anything.
    state = rest_state(tuft);
    if (model) *model = {};
    return {solved.iterations, false, 1, 0, 0, {}};
  }
  state.paper_from_handle = pose;
  state.placed = true;
  if (model) *model = contact_model(tuft, frozen, state.x, solved.multipliers);
  const Wrench on_hand = contact_wrench(tuft, frozen, state.x, solved.multipliers);
  settle(tuft, state, frozen, solved.multipliers);
  return {solved.iterations, solved.converged, solved.residual, solved.violation, solved.value, on_hand};
}

}  // namespace fude
