// Two tools at once, of one tracker or of two.
#pragma once

#include <string>
#include <utility>

#include "calibration/report.h"
#include "rig/calibration/calibrator.h"
#include "rig/calibration/stream_choice.h"
#include "signal/pose_sample.h"

namespace fude {

class TwoTools {
 public:
  // `tool` empty: the only one beside `other`.
  TwoTools(const std::string& tool, const std::string& other);

  void begin(DeviceNumber device, const DeviceDescription& description);

  // The pose, where it is of one of the two. Errors: as StreamChoice::takes.
  struct Heard {
    const PoseSample* of_tool = nullptr;
    const PoseSample* of_other = nullptr;
  };
  Result<Heard> hear(DeviceNumber device, const Sample& sample);

  // Errors: not_found where one of them was never heard.
  Result<void> found() const;

  // Whose the result is: of the tool, and made with both devices; or of the tool's tracker alone, whatever it
  // sees, unless the same one sees the other tool too.
  void sign(CalibrationReport& report) const;
  void sign_tracker(CalibrationReport& report) const;

 private:
  StreamChoice tool_, other_;
};

// By a procedure with add() for the poses of the tool and add_other() for those of the other.
template <class Procedure>
class TwoToolCalibrator final : public Calibrator {
 public:
  using Sign = void (TwoTools::*)(CalibrationReport&) const;
  TwoToolCalibrator(TwoTools tools, Sign sign) : tools_(std::move(tools)), sign_(sign) {}

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
    (tools_.*sign_)(outcome.report);
    return outcome;
  }

 private:
  TwoTools tools_;
  Sign sign_;
  Procedure procedure_;
  Progress progress_;
};

}  // namespace fude
