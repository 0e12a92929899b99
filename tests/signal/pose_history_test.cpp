#include "signal/pose_history.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

#include "signal/clock_fit.h"
#include "tests/fakes/recordings.h"

namespace fude {
namespace {

using std::chrono::milliseconds;

double degrees_between(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  return a.angularDistance(b) * 180 / std::numbers::pi;
}

PoseSample turned(int ms, double angle_rad, double x_m) {
  PoseSample s;
  s.time.host = Timestamp(milliseconds(ms));
  s.tracker_from_tool.rotation = Eigen::AngleAxisd(angle_rad, Eigen::Vector3d(1, 2, 2) / 3);
  s.tracker_from_tool.translation = {x_m, 0, -x_m};
  return s;
}

TEST(PoseHistory, BetweenTwoSamplesItTurnsEvenlyAndMovesStraight) {
  PoseHistory history;
  history.add(turned(0, 0.2, 1));
  history.add(turned(40, 1.0, 2));
  const PoseAnswer answer = history.at(Timestamp(milliseconds(10)));
  EXPECT_EQ(answer.origin, PoseOrigin::interpolated);
  EXPECT_LT(degrees_between(answer.tracker_from_tool.rotation, turned(0, 0.4, 0).tracker_from_tool.rotation),
            1e-6);
  EXPECT_NEAR(answer.tracker_from_tool.translation.x(), 1.25, 1e-12);
  EXPECT_NEAR(answer.tracker_from_tool.translation.z(), -1.25, 1e-12);
}

TEST(PoseHistory, AQuaternionAndItsNegativeAreOneRotation) {
  PoseHistory history;
  history.add(turned(0, 0.2, 0));
  PoseSample other = turned(40, 0.4, 0);
  other.tracker_from_tool.rotation.coeffs() *= -1;
  history.add(other);
  EXPECT_LT(degrees_between(history.at(Timestamp(milliseconds(20))).tracker_from_tool.rotation,
                            turned(0, 0.3, 0).tracker_from_tool.rotation),
            1e-6);
}

TEST(PoseHistory, EachAnswerSaysHowItWasMade) {
  PoseHistory history(
      {.samples = 10, .longest_span = milliseconds(50), .longest_prediction = milliseconds(20)});
  history.add(turned(0, 0, 0));
  history.add(turned(40, 0.1, 4));
  const auto origin = [&](int ms) { return history.at(Timestamp(milliseconds(ms))).origin; };
  EXPECT_EQ(origin(-1), PoseOrigin::none);
  EXPECT_EQ(origin(0), PoseOrigin::measured);
  EXPECT_EQ(origin(39), PoseOrigin::interpolated);
  EXPECT_EQ(origin(40), PoseOrigin::measured);
  EXPECT_EQ(origin(60), PoseOrigin::predicted);
  EXPECT_EQ(origin(61), PoseOrigin::none);
  EXPECT_NEAR(history.at(Timestamp(milliseconds(60))).tracker_from_tool.translation.x(), 6, 1e-12);
}

TEST(PoseHistory, NothingIsInterpolatedAcrossWhatWasNotSeen) {
  PoseHistory history({.samples = 10, .longest_span = milliseconds(50)});
  history.add(turned(0, 0, 0));
  PoseSample lost = turned(20, 0, 0);
  lost.valid = false;
  history.add(lost);
  history.add(turned(40, 0, 0));
  PoseSample later = turned(60, 0, 0);
  later.after_gap = true;
  history.add(later);
  history.add(turned(111, 0, 0));
  for (const int ms : {10, 20, 30, 50, 90})
    EXPECT_EQ(history.at(Timestamp(milliseconds(ms))).origin, PoseOrigin::none) << ms;
}

TEST(PoseHistory, ItIsBoundedAndTimeDoesNotRunBackwards) {
  PoseHistory history({.samples = 3});
  for (int ms = 0; ms < 10; ++ms) EXPECT_TRUE(history.add(turned(ms, 0, ms)));
  EXPECT_FALSE(history.add(turned(9, 0, 1)));
  EXPECT_EQ(history.size(), 3U);
  EXPECT_EQ(history.at(Timestamp(milliseconds(6))).origin, PoseOrigin::none);
  EXPECT_EQ(history.at(Timestamp(milliseconds(7))).origin, PoseOrigin::measured);
}

// PLUS's recording of a probe in a moving hand, stamped on arrival and by the fit of its frame numbers.
class Probe : public testing::Test {
 protected:
  void SetUp() override {
    REQUIRE_RECORDING("tracker/plus_transform_interpolation.csv");
    std::ifstream file(recordings() / "tracker/plus_transform_interpolation.csv");
    std::string line, field;
    std::getline(file, line);
    std::vector<ClockReading> readings;
    while (std::getline(file, line)) {
      std::istringstream fields(line);
      std::vector<double> values;
      while (std::getline(fields, field, ',')) values.push_back(std::stod(field));
      PoseSample s;
      s.time.host = Timestamp(Duration(std::llround((values[1] - 1898000) * 1e9)));
      readings.push_back({s.time.host, static_cast<std::uint64_t>(values[2])});
      Eigen::Matrix3d rotation;
      for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c) rotation(r, c) = values[static_cast<std::size_t>(4 + 4 * r + c)];
      s.tracker_from_tool.rotation = Eigen::Quaterniond(rotation).normalized();
      s.tracker_from_tool.translation = {values[7] / 1e3, values[11] / 1e3, values[15] / 1e3};
      s.valid = values[16] != 0;
      samples_.push_back(s);
    }
    ASSERT_EQ(samples_.size(), 500U);
    const ClockFit fit = fit_clock(readings, {});
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      fitted_.push_back(samples_[i]);
      fitted_.back().time.host = fit.readings[i].fitted;
    }
  }

  static double millimetres_between(const Pose<Tracker, Tool>& a, const Pose<Tracker, Tool>& b) {
    return (a.translation - b.translation).norm() * 1e3;
  }

  std::vector<PoseSample> samples_;
  std::vector<PoseSample> fitted_;  // the same, their times on the line
};

// As in PLUS's own test: at five times the frame rate no step is beyond 1 degree and 0.5 mm.
TEST_F(Probe, PosesBetweenTheFramesStepByLessThanADegreeAndHalfAMillimetre) {
  PoseHistory history;
  for (const PoseSample& s : fitted_) history.add(s);
  PoseAnswer before;
  int interpolated = 0;
  for (Timestamp t = fitted_.front().time.host; t < fitted_.back().time.host; t += milliseconds(4)) {
    const PoseAnswer answer = history.at(t);
    interpolated += answer.origin == PoseOrigin::interpolated;
    if (answer.origin != PoseOrigin::none && before.origin != PoseOrigin::none) {
      EXPECT_LT(degrees_between(answer.tracker_from_tool.rotation, before.tracker_from_tool.rotation), 1.0);
      EXPECT_LT(millimetres_between(answer.tracker_from_tool, before.tracker_from_tool), 0.5);
    }
    before = answer;
  }
  EXPECT_GT(interpolated, 2400);
}

// A line knows nothing of the hand's acceleration over the 40 ms around a dropped frame.
TEST_F(Probe, OfTheDroppedFrames98InAHundredComeBackWithinADegreeAndHalfAMillimetre) {
  for (const std::size_t parity : {0U, 1U}) {
    PoseHistory history;
    for (std::size_t i = parity; i < samples_.size(); i += 2) history.add(samples_[i]);
    int interpolated = 0, within = 0;
    for (std::size_t i = 1 - parity; i < samples_.size(); i += 2) {
      const PoseAnswer answer = history.at(samples_[i].time.host);
      if (answer.origin != PoseOrigin::interpolated || !samples_[i].valid) continue;
      const Pose<Tracker, Tool>& truth = samples_[i].tracker_from_tool;
      const double turn = degrees_between(answer.tracker_from_tool.rotation, truth.rotation);
      const double way = millimetres_between(answer.tracker_from_tool, truth);
      ++interpolated;
      within += turn < 1.0 && way < 0.5;
      EXPECT_LT(turn, 1.3) << i;
      EXPECT_LT(way, 1.0) << i;
    }
    EXPECT_GE(interpolated, 247);
    EXPECT_GE(within, 0.98 * interpolated);
  }
}

}  // namespace
}  // namespace fude
