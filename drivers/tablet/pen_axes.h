// How one axis of one tablet turns counts into fractions and angles. Pure; from the description
// alone.
#pragma once

#include <linux/input-event-codes.h>

#include <array>
#include <cstdint>

#include "signal/device.h"
#include "signal/units.h"

namespace fude {

// The tools that write. A puck (mouse, lens) is no pen.
inline constexpr std::array<std::uint16_t, 5> pen_tool_keys{BTN_TOOL_PEN, BTN_TOOL_RUBBER, BTN_TOOL_BRUSH,
                                                            BTN_TOOL_PENCIL, BTN_TOOL_AIRBRUSH};

// The axis with this ABS_* code, or null.
const AxisRange* find_axis(const DeviceDescription& device, std::uint16_t code);
bool has_key(const DeviceDescription& device, std::uint16_t code);

// An axis with counts on both ends; a range of one value says nothing.
inline bool usable(const AxisRange* axis) { return axis != nullptr && axis->maximum > axis->minimum; }

// The share of the axis's own range, held within 0 to 1.
Fraction share_of_range(const AxisRange& axis, std::int32_t counts);

// The count where a symmetric axis stands level: 64 of 0..127, 0 of -64..63, 0 of -60..60. The plain
// middle of an even number of counts would lean by half a count.
double centre(const AxisRange& axis);

// The lean from vertical, held within ±90°. With a resolution r (counts a radian) it is
// (counts - centre)/r; without one, half the range is 64°, as Wacom's tablets have it.
Radians lean(const AxisRange& axis, std::int32_t counts);

// Turn of the barrel: the whole range is one full turn (-900..899: 0.2° a count), held within ±180°.
Radians turn(const AxisRange& axis, std::int32_t counts);

}  // namespace fude
