// What a tuft does under the hand.
#include "sim/brush/tuft_step.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/sim/brush/gesture.h"

namespace fude {
namespace {

constexpr double step_s = 0.004;

// Leads the tuft through `seconds` of poses; every step must converge.
template <class PoseAt>
void lead(const Tuft& tuft, TuftState& state, double seconds, PoseAt pose_at) {
  const int steps = static_cast<int>(std::llround(seconds / step_s));
  for (int i = 1; i <= steps; ++i)
    ASSERT_TRUE(advance(tuft, state, pose_at(i * step_s), step_s, !state.placed).converged) << "step " << i;
}

Eigen::Vector3d tip_of(const Tuft& tuft, const TuftState& state) {
  return pose_skeleton(tuft, state.x, state.paper_from_handle).node[static_cast<std::size_t>(tuft.segments)];
}

double largest_bend(const Tuft& tuft, const TuftState& state) {
  const Layout layout{tuft.segments};
  double largest = 0;
  for (int i = 0; i < tuft.segments; ++i)
    largest = std::max(largest, std::hypot(state.x[layout.bend(i)], state.x[layout.side_bend(i)]));
  return largest;
}

TEST(Tuft, SegmentsAreShorterTowardsTheTip) {
  const Tuft tuft = make_tuft(BrushSpec{});
  double total = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(tuft.segments); ++i) {
    total += tuft.length_mm[i];
    if (i == 0) continue;
    EXPECT_LT(tuft.length_mm[i], tuft.length_mm[i - 1]);
    EXPECT_LT(tuft.bend_stiffness[i], tuft.bend_stiffness[i - 1]);
  }
  EXPECT_NEAR(total, tuft.spec.tuft_length_mm, 1e-12);
  EXPECT_EQ(tuft.twist_stiffness[0], 0);
}

TEST(TuftStep, SymmetricPressSpreadsSymmetrically) {
  const Tuft tuft = make_tuft(BrushSpec{});
  TuftState state = rest_state(tuft);
  // Leaning along x: the plane y = 0 is a mirror.
  lead(tuft, state, 0.6, [](double t) { return leaning(0, 0, 33 - 17 * ease(t / 0.4), 0.3, 0); });
  const Layout layout{tuft.segments};
  double widest = 0;
  for (int k = 1; k < tuft.segments; ++k) {
    EXPECT_NEAR(state.x[layout.stretch(k, 0)], state.x[layout.stretch(k, 1)], 1e-4) << k;
    widest = std::max(widest, state.x[layout.stretch(k, 0)]);
  }
  EXPECT_GT(widest, 0.5);
  EXPECT_NEAR(tip_of(tuft, state).y(), 0, 1e-3);
  // Spread while flattened: the lateral lines lie level, the sections are thinner than at rest.
  const Skeleton skeleton = pose_skeleton(tuft, state.x, state.paper_from_handle);
  for (std::size_t k = 2; k < static_cast<std::size_t>(tuft.segments); ++k) {
    EXPECT_NEAR(skeleton.lateral[k].z(), 0, 1e-3);
    EXPECT_LT(state.minor_mm[k], tuft.radius_mm[k]);
  }
}

TEST(TuftStep, WithoutSpreadItStaysRound) {
  BrushSpec spec;
  spec.spread = false;
  const Tuft tuft = make_tuft(spec);
  TuftState state = rest_state(tuft);
  lead(tuft, state, 0.6, [](double t) { return leaning(0, 0, 33 - 17 * ease(t / 0.4), 0.3, 0); });
  for (std::size_t k = 1; k < static_cast<std::size_t>(tuft.segments); ++k)
    EXPECT_NEAR(state.minor_mm[k], tuft.radius_mm[k], 1e-12);
}

TEST(TuftStep, OnlyTheSpineIsStoppedWithoutSectionContact) {
  const auto height_at_belly = [](bool section_contact) {
    BrushSpec spec;
    spec.section_contact = section_contact;
    const Tuft tuft = make_tuft(spec);
    TuftState state = rest_state(tuft);
    lead(tuft, state, 0.8, [](double t) { return leaning(0, 0, 33 - 22 * ease(t / 0.5), 0.3, 0); });
    return pose_skeleton(tuft, state.x, state.paper_from_handle).node[3].z();
  };
  EXPECT_LT(height_at_belly(false) + 0.3, height_at_belly(true));
}

TEST(TuftStep, StraightensInFreeAirUpToPlasticity) {
  for (const bool plastic : {false, true}) {
    BrushSpec spec;
    spec.plasticity = plastic;
    const Tuft tuft = make_tuft(spec);
    TuftState state = rest_state(tuft);
    lead(tuft, state, 2.0, [](double t) {
      return leaning(20 * ease(t - 0.5), 0, 33 - 15 * ease(t / 0.4) + 60 * ease((t - 1.5) / 0.2), 0.2, 0);
    });
    EXPECT_LE(largest_bend(tuft, state), plastic ? spec.plasticity_rad + 1e-3 : 1e-3);
    EXPECT_GE(largest_bend(tuft, state), plastic ? 0.3 * spec.plasticity_rad : 0);
    EXPECT_FALSE(state.in_contact);
  }
}

TEST(TuftStep, FreeAirCostsNoIterations) {
  const Tuft tuft = make_tuft(BrushSpec{});
  TuftState state = rest_state(tuft);
  for (int i = 0; i < 400; ++i) {
    const SolveReport report =
        advance(tuft, state, leaning(0.5 * i, std::sin(0.1 * i), 60, 0.3 * std::sin(0.05 * i), 0.01 * i),
                step_s, i == 0);
    EXPECT_LE(report.iterations, 1);
    EXPECT_TRUE(report.converged);
  }
}

TEST(TuftStep, UprightTuftBendsWhenPressedAndTrailsWhenDrawn) {
  const Tuft tuft = make_tuft(BrushSpec{});
  TuftState state = rest_state(tuft);
  lead(tuft, state, 1.6,
       [](double t) { return upright(40 * ease((t - 0.4) / 1.0), 0, 33 - 10 * ease(t / 0.4)); });
  EXPECT_LT(tip_of(tuft, state).x() - 40, -5);
  EXPECT_GT(tip_of(tuft, state).z(), 0);
}

TEST(TuftStep, RubsHarderAcrossTheHair) {
  // The same slip, once along and once across hair that lies along x.
  const auto rub = [](const Eigen::Vector2d& slip, bool anisotropic) {
    BrushSpec spec;
    spec.friction_anisotropy = anisotropic;
    const Tuft tuft = make_tuft(spec);
    TuftState state = rest_state(tuft);
    FrozenStep frozen = freeze_step(tuft, state, upright(0, 0, 100), step_s);
    frozen.rubbing_count = 1;
    frozen.rubbing[0] = {tuft.segments, -1, 10, -slip, {1, 0}};
    Evaluation at;
    TuftProgram(tuft, frozen).evaluate(state.x, at);
    return at.value;
  };
  const BrushSpec spec;
  const double far = 100 * spec.friction_slip_mm;
  const double expected = spec.friction_across / spec.friction_along;
  EXPECT_NEAR(rub({0, far}, true) / rub({far, 0}, true), expected, 0.02 * expected);
  EXPECT_NEAR(rub({0, far}, false), rub({far, 0}, false), 1e-9);
  EXPECT_NEAR(rub({0, 0}, true), 0, 1e-9);
}

TEST(TuftStep, PoresHoldAPushedTip) {
  // Leaning back, then pushed the way the tip points.
  const auto slipped = [](bool pores) {
    BrushSpec spec;
    spec.pore_resistance = pores;
    spec.pore_strength_mn = 500;
    spec.pore_critical_tilt_rad = 1.5;
    spec.pore_pressure_lead_mm = 0;
    const Tuft tuft = make_tuft(spec);
    TuftState state = rest_state(tuft);
    lead(tuft, state, 0.3, [](double t) { return leaning(0, 0, 31 - 4 * ease(t / 0.3), 0.5, 3.14159265); });
    const double before = tip_of(tuft, state).x();
    lead(tuft, state, 0.3, [](double t) { return leaning(6 * ease(t / 0.3), 0, 27, 0.5, 3.14159265); });
    return tip_of(tuft, state).x() - before;
  };
  const BrushSpec spec;
  EXPECT_GT(slipped(false), 4);
  EXPECT_LE(slipped(true), spec.pore_lead_mm + 0.05);
}

TEST(TuftStep, HostilePosesNeverEndInNonsense) {
  const Tuft tuft = make_tuft(BrushSpec{});
  TuftState state = rest_state(tuft);
  Pose<Paper, Handle> upside_down = upright(0, 0, 5);
  upside_down.rotation = Eigen::Quaterniond(Eigen::AngleAxisd(3.1, Eigen::Vector3d::UnitX()));
  const Pose<Paper, Handle> poses[] = {
      upright(0, 0, 20),   upright(100, 0, 20),         upright(100, 0, -500),       upside_down,
      upright(0, 0, 3),    leaning(0, 0, 1, 1.57, 0),   leaning(30, 0, 8, 1.57, 2),  upright(-50, 80, 12),
      upright(0, 0, 1000), leaning(5, 5, 6.4, 2.5, -1), leaning(5, 5, 6.4, -2.5, 1), upright(0, 0, 20)};
  for (const double dt : {0.0, 1e-9, 0.001, 0.01, 1.0, 1e9})
    for (int round = 0; round < 3; ++round)
      for (const Pose<Paper, Handle>& pose : poses) {
        const SolveReport report = advance(tuft, state, pose, dt, round == 1);
        ASSERT_TRUE(state.x.allFinite());
        ASSERT_TRUE(state.reactions.allFinite());
        ASSERT_TRUE(tip_of(tuft, state).allFinite());
        ASSERT_TRUE(std::isfinite(report.kkt_residual));
        // Where it says converged, nothing stands in the paper.
        if (!report.converged) continue;
        EXPECT_LE(report.violation_mm, 1e-6 * tuft.spec.tuft_length_mm);
      }
}

}  // namespace
}  // namespace fude
