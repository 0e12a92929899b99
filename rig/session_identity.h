// Which session a result was made from, whatever its file is called now.
#pragma once

#include <string>

#include "capture/session.h"

namespace fude {

// SHA-256 of the devices, of every transfer and of every sample with its time: calibrations and settings that
// are written into a session later leave it as it is.
std::string session_identity(const Session& session);

}  // namespace fude
