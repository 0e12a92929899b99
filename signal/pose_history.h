// What a tracker said of one tool lately, and where the tool was in between. Every answer says how it was
// made.
#pragma once

#include <cstddef>
#include <deque>

#include "signal/pose_sample.h"
#include "signal/timestamp.h"

namespace fude {

struct PoseHistoryLimits {
  std::size_t samples = 1024;                              // older ones are forgotten
  Duration longest_span = std::chrono::milliseconds(100);  // between two samples, to interpolate
  Duration longest_prediction = Duration::zero();          // beyond the newest; for the display alone
};

struct PoseAnswer {
  PoseOrigin origin = PoseOrigin::none;
  Pose<Tracker, Tool> tracker_from_tool;  // says nothing where origin is none
};

// The shortest rotation from `a` (share 0) to `b` (share 1), turning evenly; shares beyond go on.
Eigen::Quaterniond slerp(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b, double share);

class PoseHistory {
 public:
  explicit PoseHistory(PoseHistoryLimits limits = {}) : limits_(limits) {}

  // Samples of one tool in the order of their host time; one that is not later than the newest replaces
  // nothing and gives false.
  bool add(const PoseSample& sample);

  // measured: a valid sample has just this time. interpolated: between two valid neighbours that no gap
  // and no more than longest_span parts; rotation by slerp, translation along the line. predicted: after
  // the newest, turning and moving on as between the last two. none: otherwise.
  PoseAnswer at(Timestamp time) const;

  std::size_t size() const { return samples_.size(); }

 private:
  bool joined(const PoseSample& a, const PoseSample& b) const;

  PoseHistoryLimits limits_;
  std::deque<PoseSample> samples_;
};

}  // namespace fude
