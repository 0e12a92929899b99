#include "rig/calibration/pivot.h"

#include <utility>

#include "calibration/pivot.h"
#include "rig/calibration/undistortion.h"

namespace fude {
namespace {

class PivotCalibrator final : public Calibrator {
 public:
  PivotCalibrator(PivotWish wish, KnownCalibrations known)
      : wish_(std::move(wish)), known_(std::move(known)), poses_(wish_.tool) {}

  void begin(DeviceNumber device, const DeviceDescription& description) override {
    poses_.begin(device, description);
  }

  Result<Progress> hear(DeviceNumber device, const Sample& sample, const Transfer*) override {
    return add(poses_.hear(device, sample));
  }

  Result<CalibrationOutcome> finish() override {
    if (const auto last = add(poses_.rest()); !last) return tl::unexpected(last.error());
    if (wish_.spin)
      if (auto spun = hear_spin(); !spun) return tl::unexpected(spun.error());
    auto outcome = outcome_of(procedure_.finish());
    poses_.sign_tool(outcome.report);
    return outcome;
  }

 private:
  Result<Progress> add(const Result<std::vector<PoseSample>>& poses) {
    if (!poses) return tl::unexpected(poses.error());
    for (const PoseSample& pose : *poses) progress_ = procedure_.add(pose);
    return progress_;
  }

  Result<void> hear_spin() {
    const auto session = read_session(*wish_.spin);
    if (!session) return tl::unexpected(session.error());
    procedure_.begin_spin();
    ToolPoses poses(wish_.tool);
    for (const RecordedDevice& device : session->devices) poses.begin(device.number, device.description);
    auto heard = for_each_straight_pose(*session, known_,
                                        [&](DeviceNumber device, const PoseSample& pose) -> Result<void> {
                                          return add(poses.hear(device, pose)).map([](const Progress&) {});
                                        });
    if (!heard) return heard;
    return add(poses.rest()).map([](const Progress&) {});
  }

  PivotWish wish_;
  KnownCalibrations known_;
  ToolPoses poses_;
  PivotProcedure procedure_;
  Progress progress_;
};

}  // namespace

std::unique_ptr<Calibrator> pivot_calibrator(PivotWish wish, KnownCalibrations known) {
  return std::make_unique<PivotCalibrator>(std::move(wish), std::move(known));
}

}  // namespace fude
