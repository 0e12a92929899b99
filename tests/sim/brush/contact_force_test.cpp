// The force on the hand against the energy it comes from, against statics, and against a beam.
#include "sim/brush/contact_force.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "sim/brush/bench_gesture.h"
#include "sim/brush/sqp.h"
#include "sim/brush/tuft_step.h"
#include "tests/sim/brush/gesture.h"

namespace fude {
namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;
constexpr double step_s = 0.004;
constexpr double difference = 1e-4;  // mm, rad

Pose<Paper, Handle> moved(Pose<Paper, Handle> pose, int direction, double amount) {
  if (direction < 3) {
    pose.translation[direction] += amount;
  } else {
    pose.rotation = Eigen::AngleAxisd(amount, Eigen::Vector3d::Unit(direction - 3)) * pose.rotation;
  }
  return pose;
}

struct Solution {
  Variables x;
  SqpResult result;
};

// As tightly as rounding lets it.
Solution solved(const Tuft& tuft, const FrozenStep& frozen, const Variables& start) {
  const TuftProgram program(tuft, frozen);
  Solution s{start, {}};
  SquareMatrix hessian = program.spring_hessian();
  s.result = minimise(program, s.x, hessian, hessian, {.iterations = 200, .residual = 1e-9});
  return s;
}

Vector6d of(const Wrench& w) {
  Vector6d v;
  v << w.force_n, w.torque_nmm;
  return v;
}

// A step in the middle of a gesture, frozen.
struct Moment {
  Tuft tuft = make_tuft(BrushSpec{});
  FrozenStep frozen;
  Variables start;
};
Moment moment_of(const BenchGesture& gesture, double time_s) {
  Moment m;
  TuftState state = rest_state(m.tuft);
  for (double t = 0; t < time_s; t += step_s)
    advance(m.tuft, state, gesture.pose(m.tuft.spec, t), step_s, !state.placed);
  m.frozen = freeze_step(m.tuft, state, reachable_pose(m.tuft, gesture.pose(m.tuft.spec, time_s)), step_s);
  m.start = state.x;
  return m;
}

TEST(ContactForce, IsWhatTheMinimisedEnergyLosesByTheHandle) {
  double worst = 0;
  for (const BenchGesture& gesture : bench_gestures()) {
    for (const double t : {0.95, 2.95, 4.9}) {
      const Moment m = moment_of(gesture, t);
      const Solution here = solved(m.tuft, m.frozen, m.start);
      const Vector6d force = of(contact_wrench(m.tuft, m.frozen, here.x, here.result.multipliers));
      const double scale = force.norm() + 1e-3;
      for (int d = 0; d < 6; ++d) {
        const auto energy_at = [&](double amount) {
          FrozenStep frozen = m.frozen;
          frozen.paper_from_handle = moved(m.frozen.paper_from_handle, d, amount);
          return solved(m.tuft, frozen, here.x).result.value;
        };
        const double slope = (energy_at(difference) - energy_at(-difference)) / (2 * difference);  // mN
        worst = std::max(worst, std::abs(force[d] + 1e-3 * slope) / scale);
        EXPECT_NEAR(force[d], -1e-3 * slope, 2e-3 * scale)
            << gesture.name << " at " << t << ", direction " << d;
      }
    }
  }
  std::printf("figure: force and torque on the hand are the energy's slope within %.1e of the wrench\n",
              worst);
}

TEST(ContactForce, StiffnessIsHowTheForceChanges) {
  double worst = 0;
  for (const BenchGesture& gesture : bench_gestures().first(2)) {
    const Moment m = moment_of(gesture, 2.95);
    const Solution here = solved(m.tuft, m.frozen, m.start);
    const ContactModel model = contact_model(m.tuft, m.frozen, here.x, here.result.multipliers);
    EXPECT_EQ(of(model.wrench), of(contact_wrench(m.tuft, m.frozen, here.x, here.result.multipliers)));
    EXPECT_GT(model.stiffness(2, 2), 0);
    for (int d = 0; d < 6; ++d) {
      const auto force_at = [&](double amount) {
        FrozenStep frozen = m.frozen;
        frozen.paper_from_handle = moved(m.frozen.paper_from_handle, d, amount);
        const Solution there = solved(m.tuft, frozen, here.x);
        return of(contact_wrench(m.tuft, frozen, there.x, there.result.multipliers));
      };
      const Vector6d slope = (force_at(difference) - force_at(-difference)) / (2 * difference);
      const double scale = model.stiffness.col(d).norm() + 1e-3;
      worst = std::max(worst, (model.stiffness.col(d) + slope).norm() / scale);
    }
  }
  EXPECT_LE(worst, 0.01);
  std::printf("figure: stiffness of the contact model within %.1e of solves beside it\n", worst);
}

// Hair without friction, spread and memory, that stands with its tip on the paper at a slant and is lowered a
// little.
struct Beam {
  BrushSpec spec;
  double tilt_rad = 1.0;
  double sagged_mm = 0.02;
};

Wrench pressed(const Beam& beam, const Tuft& tuft) {
  TuftState state = rest_state(tuft);
  const double touching = std::cos(beam.tilt_rad) * beam.spec.tuft_length_mm;
  SolveReport report;
  for (const double height : {touching + 1, touching - beam.sagged_mm, touching - beam.sagged_mm})
    report = advance(tuft, state, leaning(0, 0, height, beam.tilt_rad, 0), step_s, false);
  EXPECT_TRUE(report.converged);
  return report.on_hand;
}

Beam bare_beam() {
  Beam beam;
  beam.spec.spread = beam.spec.plasticity = beam.spec.pore_resistance = beam.spec.section_contact = false;
  beam.spec.friction_along = beam.spec.friction_across = beam.spec.adhesion_mn = 0;
  beam.spec.internal_friction_s = 0;
  return beam;
}

TEST(ContactForce, ALightlyPressedTuftIsACantilever) {
  const Beam beam = bare_beam();
  const Tuft tuft = make_tuft(beam.spec);
  // The load F is upright, the lever of joint i its level distance to the tip: sag = F Σ lever² / k.
  double compliance = 0;
  double hanging = beam.spec.tuft_length_mm;
  for (std::size_t i = 0; i < static_cast<std::size_t>(tuft.segments); ++i) {
    const double lever = hanging * std::sin(beam.tilt_rad);
    compliance += lever * lever / tuft.bend_stiffness[i];
    hanging -= tuft.length_mm[i];
  }
  const Wrench hand = pressed(beam, tuft);
  const double expected = 1e-3 * beam.sagged_mm / compliance;
  EXPECT_NEAR(hand.force_n.z(), expected, 0.01 * expected);
  EXPECT_NEAR(hand.force_n.head<2>().norm(), 0, 1e-6 * expected);
  // Statics: the moment of that load at the tip about the root, which stays where it was.
  const double lever = beam.spec.tuft_length_mm * std::sin(beam.tilt_rad);
  EXPECT_NEAR(std::abs(hand.torque_nmm.y()), lever * expected, 0.01 * lever * expected);
  EXPECT_NEAR(hand.torque_nmm.x(), 0, 1e-3 * lever * expected);
  EXPECT_NEAR(hand.torque_nmm.z(), 0, 1e-3 * lever * expected);
  std::printf(
      "figure: a tuft lowered by %.2f mm pushes with %.4f mN, the cantilever of its joints with %.4f mN\n",
      beam.sagged_mm, 1e3 * hand.force_n.z(), 1e3 * expected);
}

TEST(ContactForce, AnEvenTuftIsTheEvenBeamCutIntoJoints) {
  Beam beam = bare_beam();
  beam.spec.stiffness_fall = 0;
  beam.spec.segment_ratio = 1;
  beam.spec.segments = 8;
  const Wrench hand = pressed(beam, make_tuft(beam.spec));
  // sag = F sin² L³ / (3 E I). Joints stand at the heads of their segments, so Σ (i / n)² / n stands for the
  // third.
  const double length = beam.spec.tuft_length_mm;
  const double across = std::sin(beam.tilt_rad);
  const double beam_n =
      1e-3 * beam.sagged_mm * 3 * beam.spec.bend_stiffness / (length * length * length * across * across);
  const double n = beam.spec.segments;
  const double cut = (1.0 / 3) / ((n + 1) * (2 * n + 1) / (6 * n * n));
  std::printf(
      "figure: an even tuft of eight segments pushes %.3f times as hard as the even beam, cut it is %.3f\n",
      hand.force_n.z() / beam_n, cut);
  EXPECT_NEAR(hand.force_n.z() / beam_n, cut, 0.01 * cut);
}

TEST(ContactForce, NothingInTheAir) {
  const Tuft tuft = make_tuft(BrushSpec{});
  TuftState state = rest_state(tuft);
  ContactModel model;
  const SolveReport report = advance(tuft, state, upright(0, 0, 60), step_s, true, &model);
  EXPECT_LT(of(report.on_hand).norm(), 1e-12);
  EXPECT_LT(model.stiffness.norm(), 1e-9);
  EXPECT_EQ(model.paper_from_handle.translation, Eigen::Vector3d(0, 0, 60));
}

}  // namespace
}  // namespace fude
