// The calibrations of this rig, kept in versions under the user's folder.
//
// A folder a procedure, in it one for each device and tool, in it a file a version, 0001.toml and up, and
// `current`, a link to the one that is in use. No file is ever replaced or deleted.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rig/calibration/calibration_file.h"
#include "signal/result.h"

namespace fude {

struct KeptCalibration {
  std::filesystem::path file;
  int version = 0;
  bool current = false;
  StoredCalibration calibration;
};

class CalibrationStore {
 public:
  explicit CalibrationStore(std::filesystem::path folder) : folder_(std::move(folder)) {}
  // $XDG_DATA_HOME/fude/calibration, or ~/.local/share/fude/calibration. Errors: not_found where the
  // environment names neither.
  static Result<CalibrationStore> of_user();

  // The next version, which becomes the current one. It appears whole or not at all; several processes may
  // keep at once. Errors: storage, no_access.
  Result<KeptCalibration> keep(const StoredCalibration& calibration) const;

  // All versions of all, by procedure, device and version. A file that cannot be read is left out and told
  // in `warnings`.
  std::vector<KeptCalibration> all(std::vector<std::string>& warnings) const;

  // The current ones.
  std::vector<KeptCalibration> current(std::vector<std::string>& warnings) const;

  // Makes current what was so before the current version was kept. `device` and `tool` say of which, where
  // the procedure was done with several. Errors: not_found where there is nothing of it, or nothing before;
  // usage where several fit, naming them.
  Result<KeptCalibration> roll_back(std::string_view procedure, std::string_view device,
                                    std::string_view tool) const;

 private:
  std::filesystem::path folder_;
};

// The current ones of the user's store; none where there is no store.
std::vector<StoredCalibration> calibrations_of_user(std::vector<std::string>& warnings);

}  // namespace fude
