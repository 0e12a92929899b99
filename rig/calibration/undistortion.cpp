#include "rig/calibration/undistortion.h"

#include <utility>
#include <variant>

#include "rig/calibration/session_inputs.h"

namespace fude {
namespace {

class UndistortedCalibrator final : public Calibrator {
 public:
  UndistortedCalibrator(std::unique_ptr<Calibrator> calibrator, KnownCalibrations known)
      : calibrator_(std::move(calibrator)), undistortion_(std::move(known)) {}

  void begin(DeviceNumber device, const DeviceDescription& description) override {
    undistortion_.begin(device, description);
    calibrator_->begin(device, description);
  }

  Result<Progress> hear(DeviceNumber device, const Sample& sample, const Transfer* picture) override {
    if (const auto* pose = std::get_if<PoseSample>(&sample))
      return calibrator_->hear(device, undistortion_.straight(device, *pose), picture);
    return calibrator_->hear(device, sample, picture);
  }

  Result<CalibrationOutcome> finish() override {
    if (const auto used = undistortion_.used(); !used) return tl::unexpected(used.error());
    auto outcome = calibrator_->finish();
    if (outcome) undistortion_.describe(outcome->report);
    return outcome;
  }

 private:
  std::unique_ptr<Calibrator> calibrator_;
  Undistortion undistortion_;
};

}  // namespace

void Undistortion::begin(DeviceNumber device, const DeviceDescription& description) {
  devices_[device] = description;
}

PoseSample Undistortion::straight(DeviceNumber device, PoseSample sample) {
  const DistortionField* field = field_of(device, sample.tool);
  if (field == nullptr || !sample.valid || !sample.tracker_from_tool.translation.allFinite()) return sample;
  const CorrectedPose pose = corrected(*field, sample.tracker_from_tool);
  sample.tracker_from_tool = pose.tracker_from_tool;
  ++straightened_;
  unmapped_ += !pose.mapped;
  return sample;
}

const DistortionField* Undistortion::field_of(DeviceNumber device, const std::string& tool) {
  auto field = fields_.find({device, tool});
  if (field == fields_.end()) {
    const auto found = known_.find("distortion", {device, devices_[device], tool});
    if (!found) of_another_ = found.error();
    field = fields_
                .emplace(std::pair(device, tool),
                         found && *found ? distortion_from((*found)->result) : std::nullopt)
                .first;
  }
  return field->second ? &*field->second : nullptr;
}

Result<void> Undistortion::used() const {
  if (straightened_ == 0 && of_another_) return tl::unexpected(*of_another_);
  return {};
}

void Undistortion::describe(CalibrationReport& report) const {
  if (straightened_ == 0) return;
  report.detail("poses_undistorted", double(straightened_));
  if (unmapped_ > 0)
    report.warnings.push_back(std::to_string(unmapped_) + " of " + std::to_string(straightened_) +
                              " poses lie beyond where the tracker's distortion is mapped");
}

Result<void> for_each_straight_pose(
    const Session& session, const KnownCalibrations& known,
    const std::function<Result<void>(DeviceNumber, const PoseSample&)>& hear) {
  Undistortion undistortion(known);
  for (const RecordedDevice& device : session.devices) undistortion.begin(device.number, device.description);
  return for_each_input(session,
                        [&](DeviceNumber device, const Sample& sample, const Transfer*) -> Result<void> {
                          const auto* pose = std::get_if<PoseSample>(&sample);
                          return pose ? hear(device, undistortion.straight(device, *pose)) : Result<void>();
                        });
}

std::unique_ptr<Calibrator> undistorted(std::unique_ptr<Calibrator> calibrator, KnownCalibrations known) {
  return std::make_unique<UndistortedCalibrator>(std::move(calibrator), std::move(known));
}

}  // namespace fude
