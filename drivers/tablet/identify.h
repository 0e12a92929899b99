// What a described device is: a pen tablet or not, how large, and what it can sense.
#pragma once

#include <string>
#include <vector>

#include "signal/device.h"

namespace fude {

// A pen tablet has positions and either a pen among its tools or a pressure axis with BTN_TOUCH; a
// touch screen (fingers, no pen) is none.
bool is_pen_tablet(const DeviceDescription& device);

// The description with `kind`, and for a pen tablet the active area where it can be known: from the
// resolution of its axes, else for a Wacom from models.inl, else from libwacom's database.
DeviceDescription identified(DeviceDescription device);

// Of: x y pressure tilt rotation distance wheel eraser, in this order.
std::vector<std::string> capabilities(const DeviceDescription& device);

}  // namespace fude
