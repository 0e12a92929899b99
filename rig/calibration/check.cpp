#include "rig/calibration/check.h"

#include <utility>

#include "calibration/rig_check.h"

namespace fude {
namespace {

class RigChecker final : public Calibrator {
 public:
  RigChecker(CheckWish wish, KnownCalibrations known)
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
    outcome.report.tool = poses_.tool()->part;
    return outcome;
  }

 private:
  Result<Progress> add(const Result<std::vector<PoseSample>>& poses) {
    if (!poses) return tl::unexpected(poses.error());
    if (!procedure_ && poses_.tool())
      if (auto begun = begin_check(*poses_.tool()); !begun) return tl::unexpected(begun.error());
    for (const PoseSample& pose : *poses) progress_ = procedure_->add(pose);
    return progress_;
  }

  Result<void> begin_check(const ChosenStream& tool) {
    const auto tip = tip_of("check", wish_.tip_m, known_, tool);
    if (!tip) return tl::unexpected(tip.error());
    const auto known = known_.find("surface", tool, wish_.tool.reference);
    if (!known) return tl::unexpected(known.error());
    const auto surface = *known ? surface_from((*known)->result) : std::nullopt;
    if (!surface)
      return failure(Fault::usage, "check needs the surface as it was calibrated: give --cal SURFACE.toml");
    const bool corners = numbers_in((*known)->report.details, "corners_off_rectangle_mm").has_value();
    procedure_.emplace(*surface, *tip, corners);
    return {};
  }

  CheckWish wish_;
  KnownCalibrations known_;
  ToolPoses poses_;
  std::optional<RigCheckProcedure> procedure_;
  Progress progress_;
};

}  // namespace

std::unique_ptr<Calibrator> check_calibrator(CheckWish wish, KnownCalibrations known) {
  return std::make_unique<RigChecker>(std::move(wish), std::move(known));
}

}  // namespace fude
