// The tablets whose surface was calibrated by taps, of those that paint.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "calibration/pen_mapping.h"
#include "calibration/tablet_surface.h"
#include "rig/calibration/calibration_file.h"
#include "signal/device.h"
#include "signal/result.h"

namespace fude {

struct CalibratedTablet {
  std::vector<std::string> devices;  // identities that it was made with
  std::shared_ptr<const TabletSurface> surface;
};

// Of all calibrations those of tablets, in their order. Errors: malformed where one of them lacks a part.
Result<std::vector<CalibratedTablet>> calibrated_tablets(const std::vector<StoredCalibration>& calibrations);

// The last that was made with the device. Null: it was not calibrated.
std::shared_ptr<const TabletSurface> surface_of(const std::vector<CalibratedTablet>& tablets,
                                                const DeviceDescription& device);

// The sheet that was calibrated, else the active area; none where neither is known.
std::optional<Extent> area_of(const std::vector<CalibratedTablet>& tablets, const DeviceDescription& device);

// A calibration to paint with. Errors: those of read_calibration; usage where it is not one of a tablet.
Result<StoredCalibration> tablet_calibration(const std::filesystem::path& file);

}  // namespace fude
