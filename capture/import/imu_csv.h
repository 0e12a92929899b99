// Inertial recordings as tables: t_s, gyr_*_radps, acc_*_mps2, and where there are mag_*_uT; beside them, as
// an optical system saw the sensor, opt_qw … opt_qz (earth from sensor) and opt_*_m; movement (0 or 1) goes
// into bit 0 of the samples' buttons.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "capture/import/recording.h"
#include "signal/result.h"

namespace fude {

bool looks_like_imu_csv(std::string_view text);

// The inertial unit, then the optical system where the table has one: poses of the tool "sensor", not valid
// where its fields are nan. Rows without all their numbers, or whose time runs backwards, are passed over and
// counted. Without t_s rows are 1/`rate_hz` apart. Errors: malformed where a column or every row is missing.
Result<std::vector<RawRecording>> import_imu_csv(std::string_view text, std::optional<double> rate_hz);

}  // namespace fude
