// Which sheet a session is painted on, and where on it each device's millimetres lie.
#pragma once

#include <map>
#include <optional>

#include "calibration/pen_mapping.h"
#include "capture/session.h"
#include "signal/result.h"

namespace fude {

struct SheetPlan {
  Extent sheet;
  std::map<DeviceNumber, TabletMapping> mappings;  // devices with pen samples only
};

struct SheetWish {
  std::optional<Extent> sheet;   // --size-mm
  std::optional<Extent> tablet;  // --tablet-mm, for devices that do not state a size
};

// Without a wish the sheet is the largest active area of the devices that sent samples; where a
// device has no size, the extent of its contacts plus 20 mm. The middle of each lies on the middle of
// the sheet. Errors: unsupported where a raw tablet has no size; usage where the sheet is not between
// 1 mm and 10 m a side.
Result<SheetPlan> plan_sheet(const Session& session, const SheetWish& wish);

}  // namespace fude
