#include "rig/calibration/surface.h"

#include <utility>

#include "calibration/surface.h"

namespace fude {
namespace {

class SurfaceCalibrator final : public Calibrator {
 public:
  SurfaceCalibrator(SurfaceWish wish, KnownCalibrations known)
      : wish_(std::move(wish)), known_(std::move(known)), poses_(wish_.tool) {}

  void begin(DeviceNumber device, const DeviceDescription& description) override {
    poses_.begin(device, description);
  }

  Result<Progress> hear(DeviceNumber device, const Sample& sample, const Transfer*) override {
    return add(poses_.hear(device, sample));
  }

  Result<CalibrationOutcome> finish() override {
    if (const auto last = add(poses_.rest()); !last) return tl::unexpected(last.error());
    auto outcome = outcome_of(procedure_->finish());
    poses_.sign_frame(outcome.report);
    return outcome;
  }

 private:
  // The tip is asked for when it is known whose.
  Result<Progress> add(const Result<std::vector<PoseSample>>& poses) {
    if (!poses) return tl::unexpected(poses.error());
    if (!procedure_ && poses_.tool()) {
      const auto tip = tip_of("surface", wish_.tip_m, known_, *poses_.tool());
      if (!tip) return tl::unexpected(tip.error());
      procedure_.emplace(*tip, wish_.corners_first);
    }
    for (const PoseSample& pose : *poses) progress_ = procedure_->add(pose);
    return progress_;
  }

  SurfaceWish wish_;
  KnownCalibrations known_;
  ToolPoses poses_;
  std::optional<SurfaceProcedure> procedure_;
  Progress progress_;
};

}  // namespace

std::unique_ptr<Calibrator> surface_calibrator(SurfaceWish wish, KnownCalibrations known) {
  return std::make_unique<SurfaceCalibrator>(std::move(wish), std::move(known));
}

}  // namespace fude
