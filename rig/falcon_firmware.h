// The image that a Falcon is given after power-on: the user's own file, for fude has none
// (firmware-notes/falcon.md).
#pragma once

#include <cstddef>
#include <vector>

#include "signal/result.h"

namespace fude {

// fude/falcon-firmware.bin in the user's data folder; empty where it is not there or longer than any image.
std::vector<std::byte> falcon_firmware();

// What a person is told when an arm asks for it in vain, or does not take it.
Error no_falcon_firmware();
Error falcon_firmware_refused();

}  // namespace fude
