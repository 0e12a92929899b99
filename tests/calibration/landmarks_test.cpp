#include "calibration/landmarks.h"

#include <gtest/gtest.h>

#include <limits>
#include <utility>

#include "tests/fakes/scripted_tracker.h"

namespace fude {
namespace {

const TrackerRegistration truth{
    Eigen::Quaterniond(Eigen::AngleAxisd(2, Eigen::Vector3d(1, -2, 0.5).normalized())), {0.3, -0.2, 1.4}};

std::vector<Landmark> listed() {
  return {{"a", {0, 0, 0}},        {"b", {0.3, 0, 0}},       {"c", {0.28, 0.2, 0.01}},  {"d", {0, 0.21, 0}},
          {"e", {0.1, 0.1, 0.12}}, {"f", {0.2, 0.05, 0.07}}, {"g", {0.05, 0.15, -0.04}}};
}

// Where the tracker sees them.
Points3 measured(double noise_m = 0, std::uint32_t seed = 1) {
  Noise noise(seed);
  Points3 points;
  for (const Landmark& l : listed()) points.push_back(truth.inverse() * l.at_m + noise.vector(noise_m));
  return points;
}

Calibration<TrackerRegistration> registered(const Points3& points, std::vector<Landmark> list = listed()) {
  LandmarkProcedure procedure(std::move(list));
  for (const Eigen::Vector3d& p : points) procedure.add(p);
  return procedure.finish();
}

TEST(Landmarks, ExactPointsGiveTheMotion) {
  const auto found = registered(measured());
  ASSERT_TRUE(found) << found.error().reason;
  EXPECT_LT(found->value.rotation.angularDistance(truth.rotation), 1e-7);
  EXPECT_LT((found->value.translation - truth.translation).norm(), 1e-9);
  EXPECT_TRUE(found->report.warnings.empty());
}

TEST(Landmarks, TheStatedRadiusHoldsTheTruthAtTheLandmarks) {
  int within = 0;
  for (std::uint32_t seed = 0; seed < 100; ++seed) {
    const auto found = registered(measured(0.3e-3, seed));
    ASSERT_TRUE(found) << found.error().reason;
    const Points3 exact = measured();
    for (std::size_t i = 0; i < exact.size(); ++i)
      within += 1e3 * (found->value * exact[i] - listed()[i].at_m).norm() < (*found->report.ci95)[1];
  }
  EXPECT_GE(within, 665);  // of 700
}

TEST(Landmarks, AScaledFitIsUmeyamas) {
  Points3 from = measured(), to;
  for (const Landmark& l : listed()) to.push_back(1.7 * l.at_m);
  const Similarity fit = register_points(from, to, Freedom::scaled);
  EXPECT_NEAR(fit.scale, 1.7, 1e-9);
  for (std::size_t i = 0; i < to.size(); ++i) EXPECT_LT((fit(from[i]) - to[i]).norm(), 1e-9);
}

TEST(Landmarks, OneThatWasTouchedBadlyIsNamed) {
  Points3 points = measured(0.2e-3);
  points[2].x() += 0.02;
  const auto found = registered(points);
  ASSERT_TRUE(found) << found.error().reason;
  EXPECT_LT((found->value.translation - truth.translation).norm(), 2e-3);
  ASSERT_FALSE(found->report.warnings.empty());
  EXPECT_NE(found->report.warnings[0].find("left out: c"), std::string::npos) << found->report.warnings[0];
}

TEST(Landmarks, ASmallScaleIsAWarning) {
  Points3 points = measured(0.05e-3);
  for (Eigen::Vector3d& p : points) p *= 1.02;
  const auto found = registered(points);
  ASSERT_TRUE(found) << found.error().reason;
  bool warned = false;
  for (const std::string& w : found->report.warnings)
    warned = warned || w.find("a scale of 0.98") != std::string::npos;
  EXPECT_TRUE(warned);
}

TEST(Landmarks, ResultsReadBack) {
  const auto read = registration_from(to_fields(truth));
  ASSERT_TRUE(read);
  EXPECT_LT(read->rotation.angularDistance(truth.rotation), 1e-9);
  EXPECT_EQ(read->translation, truth.translation);
}

void expect_refused(const Points3& points, const std::string& cause, std::vector<Landmark> list = listed()) {
  const auto found = registered(points, std::move(list));
  ASSERT_FALSE(found) << "accepted, where it should name: " << cause;
  EXPECT_NE(found.error().reason.find(cause), std::string::npos) << found.error().reason;
}

TEST(LandmarksRefuse, InchesForMillimetres) {
  Points3 points = measured(0.2e-3);
  for (Eigen::Vector3d& p : points) p /= 25.4;
  expect_refused(points, "look like inches");
}

TEST(LandmarksRefuse, AMirrorImage) {
  Points3 points = measured(0.2e-3);
  for (Eigen::Vector3d& p : points) p.y() = -p.y();
  expect_refused(points, "mirror image");
}

TEST(LandmarksRefuse, TwoThatWereExchanged) {
  Points3 points = measured(0.2e-3);
  std::swap(points[1], points[4]);
  expect_refused(points, "were b and e touched in the other order?");
}

TEST(LandmarksRefuse, AnotherNumberOfPointsOrTooFew) {
  Points3 points = measured();
  points.pop_back();
  expect_refused(points, "6 points were measured, but 7");
  const auto list = listed();
  expect_refused({points[0], points[1]}, "3 are the fewest", {list[0], list[1]});
}

TEST(LandmarksRefuse, LinesAndOnePlaceAndNoNumbers) {
  std::vector<Landmark> line;
  Points3 points;
  for (int i = 0; i < 5; ++i) {
    line.push_back({"p" + std::to_string(i), {0.1 * i, 0, 0}});
    points.push_back(truth.inverse() * line.back().at_m);
  }
  expect_refused(points, "one line", line);
  expect_refused(Points3(7, Eigen::Vector3d(1, 2, 3)), "one place");
  Points3 none = measured();
  none[3].z() = std::numeric_limits<double>::quiet_NaN();
  expect_refused(none, "no number");
}

TEST(LandmarksRefuse, PointsThatAreNotTheLandmarks) {
  Noise noise(3);
  Points3 points;
  for (int i = 0; i < 7; ++i) points.push_back(noise.vector(0.1));
  EXPECT_FALSE(registered(points));
}

}  // namespace
}  // namespace fude
