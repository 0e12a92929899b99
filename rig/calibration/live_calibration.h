// A calibration from the devices that are plugged in, whose motions may be kept as a session.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "rig/calibration/calibration_file.h"
#include "rig/calibration/calibrator.h"
#include "rig/calibration/live_hearing.h"
#include "rig/devices.h"
#include "rig/record_session.h"
#include "signal/result.h"

namespace fude {

struct LiveWish {
  std::vector<NamedDevice> named;
  std::optional<std::filesystem::path> session;  // where the motions are kept; none: nowhere
  bool overwrite = false;
  std::vector<StoredCalibration> calibrations;  // of which the session carries those of its devices
};

class LiveCalibration {
 public:
  // Hears every device that is there or comes. `warn` gets what the user should know meanwhile, from any
  // thread. `calibrator` is the rig's until finish(). Errors: not_found where nothing is plugged in or named,
  // no_access where none may be read, those of the recorder.
  static Result<std::unique_ptr<LiveCalibration>> start(Calibrator& calibrator, LiveWish wish,
                                                        std::function<void(const std::string&)> warn);

  // How far it has come; an error ends it.
  Result<Progress> progress() const { return hearing_.progress(); }

  // Ends the reading, closes the session and gives what was found. Errors: those of the calibrator and of the
  // disk; what was recorded is kept.
  Result<CalibrationOutcome> finish();

 private:
  explicit LiveCalibration(Calibrator& calibrator) : hearing_(calibrator) {}

  LiveHearing hearing_;  // before the devices, which tell it
  std::optional<std::filesystem::path> session_;
  std::unique_ptr<RecordingSession> recording_;
  std::unique_ptr<Devices> devices_;
};

}  // namespace fude
