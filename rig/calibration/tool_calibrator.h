// A calibration from one tool's poses, by a procedure that can only be begun when it is known whose they are.
#pragma once

#include <functional>
#include <optional>
#include <utility>

#include "rig/calibration/calibrator.h"
#include "rig/calibration/tool_poses.h"

namespace fude {

template <class Procedure>
class ToolCalibrator final : public Calibrator {
 public:
  using Begin = std::function<Result<Procedure>(const ChosenStream& tool)>;
  using Sign = std::function<void(const ToolPoses&, CalibrationReport&)>;

  ToolCalibrator(const ToolWish& wish, Begin begin_procedure, Sign sign)
      : poses_(wish), begin_procedure_(std::move(begin_procedure)), sign_(std::move(sign)) {}

  void begin(DeviceNumber device, const DeviceDescription& description) override {
    poses_.begin(device, description);
  }

  Result<Progress> hear(DeviceNumber device, const Sample& sample, const Transfer*) override {
    return add(poses_.hear(device, sample));
  }

  Result<CalibrationOutcome> finish() override {
    if (const auto last = add(poses_.rest()); !last) return tl::unexpected(last.error());
    auto outcome = outcome_of(procedure_->finish());
    sign_(poses_, outcome.report);
    return outcome;
  }

 private:
  Result<Progress> add(const Result<std::vector<PoseSample>>& poses) {
    if (!poses) return tl::unexpected(poses.error());
    if (!procedure_ && poses_.tool()) {
      auto begun = begin_procedure_(*poses_.tool());
      if (!begun) return tl::unexpected(begun.error());
      procedure_.emplace(std::move(*begun));
    }
    for (const PoseSample& pose : *poses) progress_ = procedure_->add(pose);
    return progress_;
  }

  ToolPoses poses_;
  Begin begin_procedure_;
  Sign sign_;
  std::optional<Procedure> procedure_;
  Progress progress_;
};

}  // namespace fude
