// Earlier calibrations that another one builds on: those that a person names, those that the session carries,
// those that are kept.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "capture/session.h"
#include "rig/calibration/calibration_file.h"
#include "rig/calibration/stream_choice.h"
#include "signal/result.h"

namespace fude {

class KnownCalibrations {
 public:
  // Named by a person. Errors: those of read_calibration.
  static Result<KnownCalibrations> read(const std::vector<std::filesystem::path>& files);

  // The passport of a session.
  void carry(const Session& session);
  // Of the user's store.
  void keep(std::vector<StoredCalibration> current);

  // The procedure's for the device and the tool of `stream`, seen from `reference` (empty: from the tracker):
  // first of those named, then of the session's, then of those kept; none where there is none. A calibration
  // without a tool is that of a frame, whichever tool is seen in it. Of those named and carried, a device
  // that has no identity (a table of numbers) fits any; those kept must be of just this device. Errors:
  // malformed where one was named for this but was made with another device, tool or reference.
  Result<std::optional<StoredCalibration>> find(std::string_view procedure, const ChosenStream& stream,
                                                const std::string& reference = {}) const;

  // What else there is of the procedure, in words: "that of the tool probe of 0f44:ff20:A1 is kept"; empty
  // where there is nothing.
  std::string others(std::string_view procedure) const;

 private:
  struct Named {
    std::string file;
    StoredCalibration calibration;
  };
  std::vector<Named> named_;
  std::vector<StoredCalibration> carried_, kept_;  // of carried ones a later one goes before
};

// The tip that was named, else that of the pivot that is known for the tool. Errors: those of find; usage
// where there is neither, in the name of the procedure that asks.
Result<Eigen::Vector3d> tip_of(std::string_view procedure, const std::optional<Eigen::Vector3d>& named_m,
                               const KnownCalibrations& known, const ChosenStream& tool);

}  // namespace fude
