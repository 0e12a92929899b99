// Devices that udev does not tell of, as a person names them.
#pragma once

#include <string>

#include "rig/devices.h"
#include "signal/result.h"

namespace fude {

// "WORD:NODE[@BAUD]" for what is wired to a serial line ("fastrak:/dev/ttyS0@115200", the default speed),
// "WORD:HOST[:PORT]" for what answers on the network ("openigtlink:127.0.0.1:18944", "vrpn:rig.local"; the
// protocol's own port by default). Errors: usage, saying what may stand there.
Result<NamedDevice> named_device(const std::string& text);

}  // namespace fude
