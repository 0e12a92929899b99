// Which sheet a session is painted on, and where on it each device's millimetres lie.
#pragma once

#include <map>
#include <optional>

#include "calibration/pen_mapping.h"
#include "capture/session.h"
#include "rig/calibrated_tablets.h"
#include "rig/pen_manner.h"
#include "signal/result.h"

namespace fude {

struct SheetPlan {
  Extent sheet;
  std::map<DeviceNumber, TabletMapping> mappings;  // devices with pen samples only
  std::vector<CalibratedTablet> calibrated;        // whether they have sent samples or not
  PenManner manner;
};

struct SheetWish {
  std::optional<Extent> sheet;   // --size-mm
  std::optional<Extent> tablet;  // --tablet-mm, for devices that do not state a size
  // Named or kept: before those that the session carries.
  std::vector<StoredCalibration> calibrations;
  PenManner manner;  // of pens that do not sense how they lean
};

// Without a wish the sheet is the largest active area of the devices that sent samples; of one that was
// calibrated, the sheet of its calibration; where a device has no size, the extent of its contacts plus 20
// mm. The middle of each lies on the middle of the sheet. Errors: unsupported where a raw tablet has no size;
// usage where the sheet is not between 1 mm and 10 m a side, or where a calibration was named and none of the
// devices is its; those of calibrated_tablets.
Result<SheetPlan> plan_sheet(const Session& session, const SheetWish& wish);

// The device, with the size that was told for one that does not state its own.
DeviceDescription sized(DeviceDescription device, const std::optional<Extent>& told);

// Of a device that comes while it is painted: by its calibration, else as mapping_for() has it.
Result<TabletMapping> mapping_on(const SheetPlan& plan, const DeviceDescription& device);

}  // namespace fude
