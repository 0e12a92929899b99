#include "rig/calibration/tracker.h"

#include <utility>

#include "calibration/landmarks.h"
#include "calibration/touches.h"
#include "rig/landmark_file.h"

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
      : wish_(std::move(wish)), known_(std::move(known)), listed_(std::move(listed)), poses_(wish_.tool) {}

  void begin(DeviceNumber device, const DeviceDescription& description) override {
    poses_.begin(device, description);
  }

  Result<Progress> hear(DeviceNumber device, const Sample& sample, const Transfer*) override {
    if (const auto added = add(poses_.hear(device, sample)); !added) return tl::unexpected(added.error());
    if (way_.size() >= looked_ + between_looks) {
      looked_ = way_.size();
      touches_ = resting_places(way_).size();
    }
    return progress();
  }

  Result<CalibrationOutcome> finish() override {
    if (const auto last = add(poses_.rest()); !last) return tl::unexpected(last.error());
    auto outcome = registered(listed_, touched());
    poses_.sign_frame(outcome.report);
    return outcome;
  }

 private:
  static constexpr std::size_t between_looks = 256;

  Result<void> add(const Result<std::vector<PoseSample>>& poses) {
    if (!poses) return tl::unexpected(poses.error());
    if (!tip_m_ && poses_.tool()) {
      const auto tip = tip_of("tracker", wish_.tip_m, known_, *poses_.tool());
      if (!tip) return tl::unexpected(tip.error());
      tip_m_ = *tip;
    }
    for (const PoseSample& pose : *poses)
      if (pose.valid) way_.push_back({pose.time.host, pose.tracker_from_tool * *tip_m_, way_.size()});
    return {};
  }

  Progress progress() const {
    if (touches_ >= listed_.size()) return {way_.size(), 1, {}};
    return {way_.size(), double(touches_) / double(listed_.size()), "touch " + listed_[touches_].name};
  }

  // Each pose, where there are as many as landmarks; else where the tip rested.
  Points3 touched() const {
    Points3 points;
    for (const TipPoint& touch : way_.size() == listed_.size() ? way_ : resting_places(way_))
      points.push_back(touch.point_m);
    return points;
  }

  TrackerWish wish_;
  KnownCalibrations known_;
  std::vector<Landmark> listed_;
  ToolPoses poses_;
  std::optional<Eigen::Vector3d> tip_m_;
  std::vector<TipPoint> way_;
  std::size_t looked_ = 0, touches_ = 0;
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
