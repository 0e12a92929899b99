#include "calibration/distortion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "calibration/fusion/motion_state.h"
#include "calibration/hand_eye.h"
#include "signal/units.h"
#include "tests/fakes/scripted_tracker.h"

namespace fude {
namespace {

// Two pieces of iron bend the field of a magnetic tracker as induced dipoles do: by the third power of the
// distance; the one beneath the table is the nearer.
Pose<Tracker, Tool> bent(const Pose<Tracker, Tool>& pose) {
  Pose<Tracker, Tool> seen = pose;
  struct Iron {
    Eigen::Vector3d at_m, pull_m, twist_rad;
    double size_m;
  };
  static const Iron irons[] = {{{0.1, -0.05, 0.02}, {0.02, -0.012, 0.016}, {0.03, 0.05, -0.02}, 0.22},
                               {{-0.35, 0.3, 0.45}, {-0.015, 0.012, 0.01}, {-0.03, 0.02, 0.04}, 0.2}};
  Eigen::Vector3d twist = Eigen::Vector3d::Zero();
  for (const Iron& iron : irons) {
    const double strength = std::pow(iron.size_m / ((pose.translation - iron.at_m).norm() + 0.05), 3);
    seen.translation += strength * iron.pull_m;
    twist += strength * iron.twist_rad;
  }
  seen.rotation = rotation_of(twist) * pose.rotation;
  return seen;
}

Pose<Tracker, Tool> waved(double t) {
  return {rotation_of({0.8 * std::sin(1.1 * t), 0.7 * std::sin(1.7 * t + 1), 0.9 * std::sin(0.7 * t + 2)}),
          {0.22 * std::sin(0.61 * t), 0.22 * std::sin(0.83 * t + 0.5), 0.4 + 0.2 * std::sin(0.47 * t + 1)}};
}

const HandEye joined{
    {rotation_of({0.5, -1, 2}), {1, 0.4, -2}}, {rotation_of({0.2, 0.1, -0.3}), {0.02, 0.01, 0.05}}, 0};

struct Streams {
  std::vector<PoseSample> magnetic, optical;
};
Streams moved(double seconds, double from = 0, std::uint32_t seed = 1) {
  Streams s;
  Noise noise(seed);
  const auto noisy = [&](Pose<Tracker, Tool> pose, double m, double rad) {
    pose.translation += noise.vector(m);
    pose.rotation = rotation_of(noise.vector(rad)) * pose.rotation;
    return pose;
  };
  for (int i = 0; i < int(seconds * 40); ++i) {
    const double t = from + i / 40.0;
    s.magnetic.push_back(pose_sample(noisy(bent(waved(t)), 0.4e-3, 0.6e-3), t));
    const auto other = joined.tracker_from_other.inverse() * waved(t) * joined.tool_from_other;
    s.optical.push_back(pose_sample(noisy({other.rotation, other.translation}, 0.1e-3, 0.3e-3), t));
  }
  return s;
}

Calibration<DistortionField> found(const std::vector<MappedPlace>& places) {
  DistortionProcedure procedure;
  for (const MappedPlace& place : places) procedure.add(place);
  return procedure.finish();
}

double number(const CalibrationReport& report, const char* key) {
  const auto numbers = numbers_in(report.details, key);
  EXPECT_TRUE(numbers) << key;
  return numbers ? numbers->front() : 0;
}

TEST(Distortion, IronIsMappedByASecondTracker) {
  const Streams streams = moved(100);
  const auto result = found(places_of_motion(streams.magnetic, streams.optical));
  ASSERT_TRUE(result) << result.error().reason;
  const CalibrationReport& r = result->report;
  std::printf(
      "figure: distortion mapped by a second tracker: %.2f mm to %.2f mm and %.2f to %.2f degrees, held "
      "out\n",
      number(r, "before_rms_mm"), *r.held_out_rms, number(r, "before_turn_rms_deg"),
      number(r, "held_out_turn_rms_deg"));
  EXPECT_LT(*r.held_out_rms, 0.35 * number(r, "before_rms_mm"));
  EXPECT_LT(number(r, "held_out_turn_rms_deg"), 0.4 * number(r, "before_turn_rms_deg"));

  // Another motion through the same volume, put right: what is left of the two trackers' disagreement.
  const Streams later = moved(40, 500, 2);
  std::vector<PoseSample> straight = later.magnetic;
  for (PoseSample& sample : straight)
    sample.tracker_from_tool = corrected(result->value, sample.tracker_from_tool).tracker_from_tool;
  const auto spread = [](const std::vector<MappedPlace>& places) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const MappedPlace& p : places) mean += p.shift_m / double(places.size());
    double sum = 0, turns = 0;
    for (const MappedPlace& p : places) {
      sum += (p.shift_m - mean).squaredNorm() / double(places.size());
      turns += p.turn_rad->squaredNorm() / double(places.size());
    }
    return std::pair(1e3 * std::sqrt(sum), in_degrees(Radians(std::sqrt(turns))));
  };
  const auto before = spread(places_of_motion(later.magnetic, later.optical));
  const auto after = spread(places_of_motion(straight, later.optical));
  std::printf("figure: distortion, another motion: %.2f mm to %.2f mm and %.2f to %.2f degrees\n",
              before.first, after.first, before.second, after.second);
  EXPECT_LT(after.first, 0.35 * before.first);
  EXPECT_LT(after.second, 0.5 * before.second);
}

struct Grid {
  std::vector<Landmark> points;
  std::vector<Pose<Tracker, Tool>> touched;
};
Grid grid(const Eigen::Vector3d& step_m, int side, int layers, std::uint32_t seed = 3) {
  Noise noise(seed);
  const Pose<Tracker, Reference> where{rotation_of({0, 0, 0.3}), {-0.2, -0.2, 0.22}};
  Grid g;
  for (int i = 0; i < side * side * layers; ++i) {
    const Eigen::Vector3d at =
        step_m.cwiseProduct(Eigen::Vector3d(i % side, i / side % side, i / (side * side)));
    g.points.push_back({"p" + std::to_string(i), at});
    Pose<Tracker, Tool> pose = bent({Eigen::Quaterniond::Identity(), where * at});
    pose.translation += noise.vector(0.3e-3);
    g.touched.push_back(pose);
  }
  return g;
}

TEST(Distortion, IronIsMappedByAGrid) {
  const Grid g = grid({0.08, 0.08, 0.09}, 6, 5);
  const auto result = found(places_of_grid(g.touched, Eigen::Vector3d::Zero(), g.points));
  ASSERT_TRUE(result) << result.error().reason;
  const CalibrationReport& r = result->report;
  std::printf("figure: distortion mapped by a grid of %zu: %.2f mm to %.2f mm, held out\n", r.n,
              number(r, "before_rms_mm"), *r.held_out_rms);
  EXPECT_LT(*r.held_out_rms, 0.4 * number(r, "before_rms_mm"));
  EXPECT_FALSE(result->value.turn_rad);
  ASSERT_EQ(r.warnings.size(), 1u);
  EXPECT_NE(r.warnings[0].find("orientation stays"), std::string::npos);
}

TEST(Distortion, BeyondTheMappedVolumeIsFlaggedAndDoesNotRunAway) {
  const Grid g = grid({0.08, 0.08, 0.09}, 6, 5);
  const auto result = found(places_of_grid(g.touched, Eigen::Vector3d::Zero(), g.points));
  ASSERT_TRUE(result) << result.error().reason;
  const auto at = [&](const Eigen::Vector3d& m) { return corrected(result->value, {{}, m}); };
  EXPECT_TRUE(at(g.touched[40].translation).mapped);
  EXPECT_TRUE(at(0.5 * (g.touched[40].translation + g.touched[41].translation)).mapped);
  const CorrectedPose far = at({3, 2, 5});
  EXPECT_FALSE(far.mapped);
  EXPECT_LT((far.tracker_from_tool.translation - Eigen::Vector3d(3, 2, 5)).norm(), 0.05);
}

TEST(Distortion, OneWrongPlaceIsLeftOut) {
  Grid g = grid({0.08, 0.08, 0.09}, 6, 5);
  g.touched[77].translation.x() += 0.06;
  const auto result = found(places_of_grid(g.touched, Eigen::Vector3d::Zero(), g.points));
  ASSERT_TRUE(result) << result.error().reason;
  EXPECT_GE(number(result->report, "outliers"), 1);
  EXPECT_LT(*result->report.held_out_rms, 0.4 * number(result->report, "before_rms_mm"));
}

TEST(Distortion, ResultsReadBack) {
  const Streams streams = moved(25);
  const auto result = found(places_of_motion(streams.magnetic, streams.optical));
  ASSERT_TRUE(result) << result.error().reason;
  const Fields fields = to_fields(result->value);
  const auto read = distortion_from(fields);
  ASSERT_TRUE(read);
  for (const double t : {3.3, 17.7, 400.0}) {
    const auto one = corrected(result->value, waved(t)), two = corrected(*read, waved(t));
    EXPECT_LT((one.tracker_from_tool.translation - two.tracker_from_tool.translation).norm(), 1e-12);
    EXPECT_LT(one.tracker_from_tool.rotation.angularDistance(two.tracker_from_tool.rotation), 1e-7);
    EXPECT_EQ(one.mapped, two.mapped);
  }
  for (std::size_t left_out = 0; left_out < fields.size(); ++left_out) {
    Fields some = fields;
    some.erase(some.begin() + std::ptrdiff_t(left_out));
    if (some.size() == 9 && fields[left_out].key == "distortion_turn_rad_free_shape") continue;
    EXPECT_FALSE(distortion_from(some)) << fields[left_out].key;
  }
}

void expect_refused(const std::vector<MappedPlace>& places, const std::string& cause) {
  const auto result = found(places);
  ASSERT_FALSE(result) << "accepted, where it should name: " << cause;
  EXPECT_NE(result.error().reason.find(cause), std::string::npos) << result.error().reason;
}

TEST(DistortionRefuses, TooFewPlanesAndNothingToCorrect) {
  const Grid few = grid({0.2, 0.2, 0.2}, 2, 2);
  expect_refused(places_of_grid(few.touched, Eigen::Vector3d::Zero(), few.points), "only 8 places");
  const Grid flat = grid({0.08, 0.08, 0}, 5, 1);
  expect_refused(places_of_grid(flat.touched, Eigen::Vector3d::Zero(), flat.points), "every height");
  Noise noise(9);
  std::vector<MappedPlace> random;
  for (int i = 0; i < 100; ++i) random.push_back({noise.vector(0.2), noise.vector(0.5e-3), std::nullopt});
  expect_refused(random, "does not help");
  for (MappedPlace& place : random) place.at_m.x() = std::numeric_limits<double>::quiet_NaN();
  expect_refused(random, "only 0 places");
}

}  // namespace
}  // namespace fude
