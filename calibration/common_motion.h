// Where one tracker stands to another, from a motion that both saw: of one tool, or of two that are rigidly
// joined.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calibration/hand_eye.h"
#include "calibration/pose_screen.h"
#include "calibration/report.h"
#include "signal/pose_sample.h"

namespace fude {

struct CommonMotion {
  Pose<Tracker, OtherTracker> tracker_from_other;  // metres
  Pose<Tool, OtherTool> tool_from_other;           // metres
};
Fields to_fields(const CommonMotion& motion);
std::optional<CommonMotion> common_motion_from(const Fields& fields);

class CommonMotionProcedure {
 public:
  // Each stream in the order of its time; the two may come one after the other.
  Progress add(const PoseSample& sample);
  Progress add_other(const PoseSample& sample);

  // The streams need no common times: the denser is interpolated at the times of the other, never across a
  // gap, and a constant lag between their clocks (up to 0.2 s) is found beside the poses and taken out.
  // Refused: a frozen stream; fewer than 30 moments seen by both; an orientation that stays; turning about
  // one axis (condition above 40); lengths in another unit; inverted poses; more than a quarter of the
  // moments off, or residuals above 5 mm or 3 degrees: not rigidly joined. Details: residuals of the turns,
  // the lag, the outliers by time. ci95: of points where the tool was, mm.
  Calibration<CommonMotion> finish() const;

 private:
  struct Stream {
    std::vector<PoseSample> samples;
    PoseScreen screen;
    std::string tool;
    void add(const PoseSample& sample);
  };
  Progress progress() const;

  Stream seen_, other_;
  Eigen::Matrix3d rotation_sum_ = Eigen::Matrix3d::Zero();
};

}  // namespace fude
