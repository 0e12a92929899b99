#include "rig/calibration/imu_axes.h"

#include <variant>

#include "calibration/sensor_axes.h"
#include "rig/calibration/stream_choice.h"

namespace fude {
namespace {

class ImuAxesCalibrator final : public Calibrator {
 public:
  explicit ImuAxesCalibrator(const ImuAxesWish& wish)
      : tool_({.name = wish.tool, .kinds = is_kind<PoseSample>}),
        unit_({.name = wish.unit, .what = "inertial unit", .option = "--imu", .kinds = is_kind<ImuSample>}) {}

  void begin(DeviceNumber device, const DeviceDescription& description) override {
    tool_.begin(device, description);
    unit_.begin(device, description);
  }

  Result<Progress> hear(DeviceNumber device, const Sample& sample, const Transfer*) override {
    const auto of_tool = tool_.takes(device, sample), of_unit = unit_.takes(device, sample);
    if (!of_tool) return tl::unexpected(of_tool.error());
    if (!of_unit) return tl::unexpected(of_unit.error());
    if (*of_tool) progress_ = procedure_.add(std::get<PoseSample>(sample));
    if (*of_unit) progress_ = procedure_.add(std::get<ImuSample>(sample));
    return progress_;
  }

  Result<CalibrationOutcome> finish() override {
    const auto tool = tool_.found(), unit = unit_.found();
    if (!tool) return tl::unexpected(tool.error());
    if (!unit) return tl::unexpected(unit.error());
    auto outcome = outcome_of(procedure_.finish());
    outcome.report.devices = {tool->device.id};
    if (unit->number != tool->number) outcome.report.devices.push_back(unit->device.id);
    outcome.report.tool = tool->part;
    return outcome;
  }

 private:
  StreamChoice tool_, unit_;
  SensorAxesProcedure procedure_;
  Progress progress_;
};

}  // namespace

std::unique_ptr<Calibrator> imu_axes_calibrator(const ImuAxesWish& wish) {
  return std::make_unique<ImuAxesCalibrator>(wish);
}

}  // namespace fude
