// Tracked tools as a table: t_s (or a rate), and for each tool NAME either NAME_m00 … NAME_m23, three rows of
// four, or NAME_qw, NAME_qx, NAME_qy, NAME_qz, NAME_x, NAME_y, NAME_z; and NAME_ok where the file says
// whether it was seen. A pose is tracker_from_NAME. Other columns are not used; frame_number or FrameNumber
// is kept as the device's tick.
#pragma once

#include <optional>
#include <string_view>

#include "capture/import/recording.h"
#include "signal/result.h"

namespace fude {

struct PosesOptions {
  std::optional<double> rate_hz;
  double metres_per_unit = 1e-3;  // millimetres, or 1
};

bool looks_like_poses_csv(std::string_view text);

// One device with all tools. A pose that is nan, no rotation (beyond 0.02), or said to be unseen is kept as
// not valid. Errors: malformed where no tool is there whole, or no row can be read; those of RowClock.
Result<RawRecording> import_poses_csv(std::string_view text, const PosesOptions& options);

}  // namespace fude
