// A stream of a session as a table of text.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "capture/streams.h"
#include "signal/pose_history.h"
#include "signal/result.h"

namespace fude {

// A comment line with the units, the names, then every sample: host_s, tick, sequence, fitted_s (host_s as
// the line of the device's clock has it; empty without one), valid, stamped_by, and what its kind has
// besides. Numbers read back to the same bits; times have nine decimals.
std::string csv_of(const Session& session, const SessionStream& stream);

// Times to be asked for: the column host_s or t_s of a table, else the first number of each line.
// Errors: malformed, with the line.
Result<std::vector<Timestamp>> read_times(std::string_view text);

// The poses of one tool at those times: host_s, how, qw, qx, qy, qz, x_m, y_m, z_m; how is `measured`,
// `interpolated` or `none` (then the rest is empty). Errors: usage where the stream holds no poses.
Result<std::string> poses_at(const Session& session, const SessionStream& stream,
                             const std::vector<Timestamp>& times, Duration longest_span);

}  // namespace fude
