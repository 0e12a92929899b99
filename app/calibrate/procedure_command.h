// What every procedure of `fude calibrate` has in common: its inputs, its outputs and its exit status.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "rig/calibration/calibrator.h"
#include "rig/calibration/known_calibrations.h"
#include "rig/calibration/tool_poses.h"
#include "signal/result.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace fude {

struct Procedure {
  std::string name;
  std::string finds;  // for --help
  std::function<Result<std::unique_ptr<Calibrator>>(KnownCalibrations)> make;
  std::function<bool()> needs_session = {};  // empty: always
  bool kept = true;                          // what it finds is for later, and not of this moment
  bool undistorted = true;                   // poses are put right by the distortion that is known
};

// A command of that name with SESSION, --cal, --out, --report, --json and --force; running it makes the
// calibrator, lets it hear the session and writes what it found.
CLI::App* add_procedure(CLI::App& calibrate, int& status, Procedure procedure);

// --tool and --reference.
void add_tool_options(CLI::App& command, ToolWish& wish);

// --tip-mm.
void add_tip_option(CLI::App& command, std::optional<Eigen::Vector3d>& tip_m);

}  // namespace fude
