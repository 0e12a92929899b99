// What a tablet's pressure weighs, from a session of presses on a kitchen scale (calibration/pressure.h).
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "calibration/pressure.h"
#include "rig/calibration/calibrator.h"
#include "signal/result.h"

namespace fude {

struct PressureWish {
  std::string tablet;  // empty: the only one
  std::vector<Weighing> weighings;
};

std::unique_ptr<Calibrator> pressure_calibrator(PressureWish wish);

// What a scale showed and when, a line each: host_s,grams, times as `fude export` writes them; # begins a
// remark. Errors: not_found; malformed, with the line.
Result<std::vector<Weighing>> read_weighings(const std::filesystem::path& file);
Result<std::vector<Weighing>> weighings_from(std::string_view text, const std::string& source);

}  // namespace fude
