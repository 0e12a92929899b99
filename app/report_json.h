// The report of a replay as JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "rig/replay.h"

namespace fude {

// The fields that docs/session-format.md lists under "the report of a replay". Numbers are numbers.
nlohmann::ordered_json as_json(const ReplayReport& report);

}  // namespace fude
