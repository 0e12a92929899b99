#include "drivers/tablet/pen_axes.h"

#include <algorithm>
#include <numbers>

namespace fude {
namespace {

double counts_between(const AxisRange& axis) {
  return static_cast<double>(axis.maximum) - static_cast<double>(axis.minimum);
}

// Counts that the range spans around: an even number of values lacks the top one.
double span(const AxisRange& axis) {
  const auto between = static_cast<std::int64_t>(axis.maximum) - axis.minimum;
  return static_cast<double>(between % 2 == 0 ? between : between + 1);
}

}  // namespace

const AxisRange* find_axis(const DeviceDescription& device, std::uint16_t code) {
  for (const AxisRange& axis : device.axes)
    if (axis.code == code) return &axis;
  return nullptr;
}

bool has_key(const DeviceDescription& device, std::uint16_t code) {
  return std::find(device.keys.begin(), device.keys.end(), code) != device.keys.end();
}

Fraction share_of_range(const AxisRange& axis, std::int32_t counts) {
  const double above = static_cast<double>(counts) - static_cast<double>(axis.minimum);
  return Fraction(std::clamp(above / counts_between(axis), 0.0, 1.0));
}

double centre(const AxisRange& axis) { return static_cast<double>(axis.minimum) + span(axis) / 2; }

Radians lean(const AxisRange& axis, std::int32_t counts) {
  const double off = static_cast<double>(counts) - centre(axis);
  const Radians leaning =
      axis.resolution > 0 ? Radians(off / axis.resolution) : degrees(64.0 * off / (span(axis) / 2));
  return std::clamp(leaning, degrees(-90), degrees(90));
}

Radians turn(const AxisRange& axis, std::int32_t counts) {
  const double off = static_cast<double>(counts) - centre(axis);
  return Radians(2 * std::numbers::pi * std::clamp(off / span(axis), -0.5, 0.5));
}

}  // namespace fude
