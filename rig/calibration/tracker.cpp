#include "rig/calibration/tracker.h"

#include <utility>

#include "calibration/landmarks.h"
#include "rig/calibration/landmark_file.h"
#include "rig/calibration/tip_touches.h"

namespace fude {
namespace {

CalibrationOutcome registered(const std::vector<Landmark>& listed, const Points3& points) {
  LandmarkProcedure procedure(listed);
  for (const Eigen::Vector3d& point : points) procedure.add(point);
  return outcome_of(procedure.finish());
}

class MeasuredLandmarks final : public Calibrator {
 public:
  MeasuredLandmarks(std::vector<Landmark> listed, Points3 measured)
      : listed_(std::move(listed)), measured_(std::move(measured)) {}

  void begin(DeviceNumber, const DeviceDescription&) override {}
  Result<Progress> hear(DeviceNumber, const Sample&, const Transfer*) override {
    return Progress{measured_.size(), 1, {}};
  }
  Result<CalibrationOutcome> finish() override { return registered(listed_, measured_); }

 private:
  std::vector<Landmark> listed_;
  Points3 measured_;
};

class TouchedLandmarks final : public Calibrator {
 public:
  TouchedLandmarks(TrackerWish wish, KnownCalibrations known, std::vector<Landmark> listed)
      : listed_(std::move(listed)),
        touches_("tracker", {std::move(wish.tool), wish.tip_m}, std::move(known)) {}

  void begin(DeviceNumber device, const DeviceDescription& description) override {
    touches_.begin(device, description);
  }

  Result<Progress> hear(DeviceNumber device, const Sample& sample, const Transfer*) override {
    return touches_.hear(device, sample).map([this] { return touches_.towards(listed_); });
  }

  Result<CalibrationOutcome> finish() override {
    if (const auto ended = touches_.end(); !ended) return tl::unexpected(ended.error());
    Points3 points;
    for (const TipTouches::Touch& touch : touches_.touches(listed_.size())) points.push_back(touch.point_m);
    auto outcome = registered(listed_, points);
    touches_.poses().sign_frame(outcome.report);
    return outcome;
  }

 private:
  std::vector<Landmark> listed_;
  TipTouches touches_;
};

}  // namespace

Result<std::unique_ptr<Calibrator>> tracker_calibrator(TrackerWish wish, KnownCalibrations known) {
  auto listed = read_landmarks(wish.landmarks);
  if (!listed) return tl::unexpected(listed.error());
  if (!wish.measured)
    return std::make_unique<TouchedLandmarks>(std::move(wish), std::move(known), std::move(*listed));
  const auto measured = read_landmarks(*wish.measured);
  if (!measured) return tl::unexpected(measured.error());
  Points3 points = in_order_of(*listed, *measured);
  return std::make_unique<MeasuredLandmarks>(std::move(*listed), std::move(points));
}

}  // namespace fude
