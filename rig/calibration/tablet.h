// A tablet's or screen's surface, from a session of taps at known places (calibration/tablet_surface.h).
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "calibration/tablet_surface.h"
#include "rig/calibration/calibrator.h"
#include "signal/result.h"

namespace fude {

struct TabletWish {
  std::string tablet;  // empty: the only one
  TapSheet sheet;
};

std::unique_ptr<Calibrator> tablet_calibrator(TabletWish wish);

// A list of places, name,x,y,z in mm from the sheet's lower left corner, z of no account. Errors: those of
// read_landmarks; usage where a place does not lie on the sheet.
Result<TapSheet> listed_taps(const std::filesystem::path& list, double width_mm, double height_mm);

}  // namespace fude
