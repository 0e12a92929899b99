// A calibration from one stream: a procedure that takes its samples as they come.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <variant>

#include "rig/calibration/calibrator.h"
#include "rig/calibration/stream_choice.h"

namespace fude {

template <class Kind, class Procedure>
class StreamCalibrator final : public Calibrator {
 public:
  // What else is to be said of an outcome once it is known whose it is.
  using Sign = std::function<void(CalibrationOutcome&, const DeviceDescription&)>;

  // `name` empty: the only stream of the kind; `what` it is to messages.
  StreamCalibrator(std::string name, std::string what, Procedure procedure, Sign sign = {})
      : stream_({.name = std::move(name), .what = std::move(what), .kinds = is_kind<Kind>}),
        procedure_(std::move(procedure)),
        sign_(std::move(sign)) {}

  void begin(DeviceNumber device, const DeviceDescription& description) override {
    stream_.begin(device, description);
  }

  Result<Progress> hear(DeviceNumber device, const Sample& sample, const Transfer*) override {
    const auto mine = stream_.takes(device, sample);
    if (!mine) return tl::unexpected(mine.error());
    if (*mine) progress_ = procedure_.add(std::get<Kind>(sample));
    return progress_;
  }

  Result<CalibrationOutcome> finish() override {
    const auto stream = stream_.found();
    if (!stream) return tl::unexpected(stream.error());
    auto outcome = outcome_of(procedure_.finish());
    outcome.report.devices = {stream->device.id};
    if (sign_) sign_(outcome, stream->device);
    return outcome;
  }

 private:
  StreamChoice stream_;
  Procedure procedure_;
  Sign sign_;
  Progress progress_;
};

}  // namespace fude
