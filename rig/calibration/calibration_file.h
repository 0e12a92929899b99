// A calibration as TOML: the result with its unit in each key, then a table [report] of how good it is.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "calibration/report.h"
#include "signal/result.h"

namespace fude {

// One that was accepted, as it is kept.
struct StoredCalibration {
  Fields result;
  CalibrationReport report;
};

// Numbers read back to the same bits.
std::string toml_of(const StoredCalibration& calibration);

// Errors: malformed, with the line, where the text is no calibration or one that was not accepted.
Result<StoredCalibration> calibration_from_toml(std::string_view text, const std::string& source);
// Also: not_found.
Result<StoredCalibration> read_calibration(const std::filesystem::path& file);

}  // namespace fude
