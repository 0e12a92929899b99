// Until when a test waits for what should come at once.
#pragma once

#include <chrono>

#include "drivers/transport/waker.h"

namespace fude::lab {

// Only so that a failure ends; long, for the machine under the guest may stop it for a while.
inline Timestamp patience() { return monotonic_now() + std::chrono::minutes(5); }

}  // namespace fude::lab
