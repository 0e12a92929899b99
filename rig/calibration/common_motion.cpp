#include "rig/calibration/common_motion.h"

#include "calibration/common_motion.h"
#include "rig/calibration/two_tools.h"

namespace fude {
namespace {

class CommonMotionCalibrator final : public Calibrator {
 public:
  explicit CommonMotionCalibrator(const CommonMotionWish& wish) : tools_(wish.tool, wish.other) {}

  void begin(DeviceNumber device, const DeviceDescription& description) override {
    tools_.begin(device, description);
  }

  Result<Progress> hear(DeviceNumber device, const Sample& sample, const Transfer*) override {
    const auto heard = tools_.hear(device, sample);
    if (!heard) return tl::unexpected(heard.error());
    if (heard->of_tool) progress_ = procedure_.add(*heard->of_tool);
    if (heard->of_other) progress_ = procedure_.add_other(*heard->of_other);
    return progress_;
  }

  Result<CalibrationOutcome> finish() override {
    if (const auto found = tools_.found(); !found) return tl::unexpected(found.error());
    auto outcome = outcome_of(procedure_.finish());
    tools_.sign(outcome.report);
    return outcome;
  }

 private:
  TwoTools tools_;
  CommonMotionProcedure procedure_;
  Progress progress_;
};

}  // namespace

std::unique_ptr<Calibrator> common_motion_calibrator(const CommonMotionWish& wish) {
  return std::make_unique<CommonMotionCalibrator>(wish);
}

}  // namespace fude
