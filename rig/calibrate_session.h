// A calibration from a recorded session: where capture and calibration meet.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "calibration/report.h"
#include "rig/calibration_file.h"
#include "signal/result.h"
#include "vision/board.h"

namespace fude {

struct CalibrationWish {
  std::string procedure;                           // one of calibration_procedures()
  std::filesystem::path session;                   // empty with `measured` alone
  std::string tool;                                // empty: the only one
  std::string reference;                           // empty: the tracker itself
  std::optional<std::filesystem::path> spin;       // pivot: a session in which the handle is spun
  std::vector<std::filesystem::path> earlier;      // calibrations that this one builds on
  std::optional<Eigen::Vector3d> tip_m;            // instead of an earlier pivot
  bool corners_first = false;                      // surface: the first four touches are the paper's corners
  std::optional<std::filesystem::path> landmarks;  // tracker: the list of the reference
  std::optional<std::filesystem::path> measured;   // tracker: as the tracker has them, instead of touches
  Board board;                                     // camera: what it sees
};

struct CalibrationOutcome {
  CalibrationReport report;
  std::optional<Fields> result;  // only where it was accepted
};

// Told now and then how far the procedure has come; may be empty.
using OnProgress = std::function<void(const Progress&)>;

std::span<const std::string_view> calibration_procedures();

// Errors: those of reading the session and the earlier calibrations; not_found for a tool that is not there;
// usage for a procedure of no such name. What the samples themselves do not bear is refused in the report.
Result<CalibrationOutcome> calibrate_session(const CalibrationWish& wish, const OnProgress& on_progress);

}  // namespace fude
