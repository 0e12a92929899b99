#include "sim/brush/tuft_energy.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/brush/section.h"
#include "sim/brush/tuft_step.h"

namespace fude {
namespace {

// A pose deep enough that every node rubs, with a plane, and a bent, turned, unevenly spread tuft.
struct BentTuft {
  Tuft tuft;
  FrozenStep frozen;
  Variables x;

  explicit BentTuft(const BrushSpec& spec) : tuft(make_tuft(spec)) {
    const Layout layout{tuft.segments};
    TuftState state = rest_state(tuft);
    for (int i = 0; i < tuft.segments; ++i) {
      state.x[layout.turn(i)] = 0.1 * std::sin(1.7 * i + 1);
      state.x[layout.bend(i)] = 0.25 + 0.05 * i;
      state.x[layout.side_bend(i)] = 0.08 * std::cos(2.0 * i);
      state.set_rad[static_cast<std::size_t>(i)] = {0.02, -0.01};
    }
    for (int k = 1; k < tuft.segments; ++k) {
      state.x[layout.stretch(k, 0)] = 0.3;
      state.x[layout.stretch(k, 1)] = 0.5;
    }
    state.submerged.fill(0.7);
    state.reactions.setConstant(30);
    state.in_contact = true;
    Pose<Paper, Handle> pose;
    pose.rotation = Eigen::Quaterniond(Eigen::AngleAxisd(0.3, Eigen::Vector3d(0.6, 0.8, 0)));
    pose.translation = {1, 2, 11};
    frozen = freeze_step(tuft, state, pose, 0.004);
    frozen.plane = {true, {0.2, -0.1}, Eigen::Vector2d(0.6, 0.8), 0.3};
    x = state.x;
    for (Eigen::Index i = 0; i < x.size(); ++i) x[i] += 0.05 * std::cos(2.3 * static_cast<double>(i));
    x[layout.yielding()] = 0.4;
  }
};

void expect_derivatives(const BrushSpec& spec) {
  const BentTuft bent(spec);
  ASSERT_GT(bent.frozen.rubbing_count, 8);
  const TuftProgram program(bent.tuft, bent.frozen);
  Evaluation at;
  program.evaluate(bent.x, at);
  const double step = 1e-6;
  for (Eigen::Index i = 0; i < bent.x.size(); ++i) {
    Variables ahead = bent.x;
    Variables behind = bent.x;
    ahead[i] += step;
    behind[i] -= step;
    Evaluation a;
    Evaluation b;
    program.evaluate(ahead, a);
    program.evaluate(behind, b);
    const double slope = (a.value - b.value) / (2 * step);
    EXPECT_NEAR(at.gradient[i], slope, 1e-6 * (1 + std::abs(slope))) << "unknown " << i;
    for (Eigen::Index j = 0; j < at.constraints.size(); ++j)
      EXPECT_NEAR(at.jacobian(j, i), (a.constraints[j] - b.constraints[j]) / (2 * step), 1e-7)
          << "constraint " << j << ", unknown " << i;
  }
}

TEST(TuftEnergy, DerivativesAreThoseOfTheEnergy) { expect_derivatives(BrushSpec{}); }

TEST(TuftEnergy, DerivativesHoldForCubicSprings) {
  BrushSpec spec;
  spec.spring_exponent = 3;
  expect_derivatives(spec);
}

TEST(TuftEnergy, DerivativesHoldWithEverythingOff) {
  BrushSpec spec;
  spec.spread = spec.friction_anisotropy = spec.section_contact = false;
  expect_derivatives(spec);
}

TEST(TuftEnergy, DerivativesHoldAtTheStraightTuft) {
  BentTuft bent{BrushSpec{}};
  bent.x.setZero();
  const TuftProgram program(bent.tuft, bent.frozen);
  Evaluation at;
  program.evaluate(bent.x, at);
  EXPECT_TRUE(at.gradient.allFinite());
  const Layout layout{bent.tuft.segments};
  // Bending sideways moves the tip at once: no turn is needed first.
  EXPECT_GT(std::abs(at.jacobian(bent.tuft.segments - 1, layout.side_bend(0))), 1);
}

TEST(TuftEnergy, SpringHessianIsThatOfTheSprings) {
  // No friction on the paper and nothing submerged: the energy is quadratic.
  const Tuft tuft = make_tuft(BrushSpec{});
  TuftState state = rest_state(tuft);
  Pose<Paper, Handle> pose;
  pose.translation.z() = 100;
  const FrozenStep frozen = freeze_step(tuft, state, pose, 0.004);
  const TuftProgram program(tuft, frozen);
  const SquareMatrix hessian = program.spring_hessian();
  Evaluation at;
  program.evaluate(Variables::Zero(hessian.rows()), at);
  const Variables at_rest = at.gradient;
  for (Eigen::Index i = 0; i < hessian.rows(); ++i) {
    Variables x = Variables::Zero(hessian.rows());
    x[i] = 0.3;
    program.evaluate(x, at);
    EXPECT_LT(((at.gradient - at_rest) / 0.3 - hessian.col(i)).norm(), 1e-9 * hessian.col(i).norm()) << i;
  }
}

TEST(Section, AreaIsConserved) {
  for (const double r : {0.1, 1.0, 4.0})
    for (const double a : {0.0, 0.5, 3.0})
      for (const double b : {0.0, 0.2, 6.0}) {
        // Two half-ellipses: area π c (a + b)/2.
        const Section s = section_of(r, a, b);
        EXPECT_NEAR(0.5 * (s.major_a + s.major_b) * s.minor, r * r, 1e-12 * r * r);
      }
}

TEST(Section, LowestPointIsThatOfTheEllipsoid) {
  const Section s = section_of(3, 1, 2);
  for (double slope = -0.95; slope < 1; slope += 0.19) {
    // Lowest of many points of the ellipsoid's outline in the vertical plane of the lateral line.
    double lowest = 0;
    for (int i = 0; i < 100000; ++i) {
      const double t = 2 * std::acos(-1.0) * i / 100000;
      const double major = std::cos(t) > 0 ? s.major_a : s.major_b;
      lowest = std::min(lowest,
                        major * std::cos(t) * slope - s.minor * std::sin(t) * std::sqrt(1 - slope * slope));
    }
    EXPECT_NEAR(reach_below(s, slope).depth, -lowest, 1e-6) << slope;
  }
}

}  // namespace
}  // namespace fude
