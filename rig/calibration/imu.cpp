#include "rig/calibration/imu.h"

#include "calibration/imu.h"
#include "rig/calibration/stream_choice.h"

namespace fude {
namespace {

class ImuCalibrator final : public Calibrator {
 public:
  explicit ImuCalibrator(const ImuWish& wish)
      : unit_({.name = wish.unit, .what = "inertial unit", .kinds = is_kind<ImuSample>}) {}

  void begin(DeviceNumber device, const DeviceDescription& description) override {
    unit_.begin(device, description);
  }

  Result<Progress> hear(DeviceNumber device, const Sample& sample, const Transfer*) override {
    const auto mine = unit_.takes(device, sample);
    if (!mine) return tl::unexpected(mine.error());
    if (*mine) progress_ = procedure_.add(std::get<ImuSample>(sample));
    return progress_;
  }

  Result<CalibrationOutcome> finish() override {
    const auto unit = unit_.found();
    if (!unit) return tl::unexpected(unit.error());
    auto outcome = outcome_of(procedure_.finish());
    outcome.report.devices = {unit->device.id};
    return outcome;
  }

 private:
  StreamChoice unit_;
  ImuProcedure procedure_;
  Progress progress_;
};

}  // namespace

std::unique_ptr<Calibrator> imu_calibrator(const ImuWish& wish) {
  return std::make_unique<ImuCalibrator>(wish);
}

}  // namespace fude
