// A calibration as something that hears a session's inputs one by one: recorded or live alike.
#pragma once

#include <functional>
#include <optional>

#include "calibration/report.h"
#include "capture/session.h"
#include "signal/device.h"
#include "signal/result.h"
#include "signal/sample.h"
#include "signal/transfer.h"

namespace fude {

struct CalibrationOutcome {
  CalibrationReport report;
  std::optional<Fields> result;  // only where it was accepted
};

template <class T>
CalibrationOutcome outcome_of(Calibration<T> calibration) {
  if (!calibration) return {std::move(calibration.error()), std::nullopt};
  return {std::move(calibration->report), to_fields(calibration->value)};
}

class Calibrator {
 public:
  virtual ~Calibrator() = default;

  // A device, before its first sample.
  virtual void begin(DeviceNumber device, const DeviceDescription& description) = 0;

  // The next input, in the order of arrival; `picture` holds the bytes of a CameraFrame, null where they are
  // not there and for every other kind. An input that is not the calibration's own changes nothing. Gives
  // how far the procedure has come. An error ends the calibration: two tools and no name, no tip.
  virtual Result<Progress> hear(DeviceNumber device, const Sample& sample, const Transfer* picture) = 0;

  // Once, at the end. Errors: not_found where nothing that was asked for was heard. What the inputs
  // themselves do not bear is refused in the report. Fills the report but for date and session.
  virtual Result<CalibrationOutcome> finish() = 0;
};

// Told now and then how far the procedure has come; may be empty.
using OnProgress = std::function<void(const Progress&)>;

}  // namespace fude
