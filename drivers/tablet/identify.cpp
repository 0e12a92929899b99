#include "drivers/tablet/identify.h"

#include <linux/input-event-codes.h>

#include <cstdint>
#include <cstdlib>
#include <memory>
#include <optional>
#include <utility>

#include "drivers/tablet/pen_axes.h"

// libwacom does not say that it is C.
extern "C" {
#include <libwacom/libwacom.h>
}

namespace fude {
namespace {

constexpr std::uint16_t wacom = 0x056a;
constexpr std::int32_t wacom_counts_per_mm = 200;

struct Models {
  std::uint16_t first_product;
  std::uint16_t last_product;
  std::int32_t counts_per_mm;
};
constexpr Models models[] = {
#define TABLET_MODELS(first, last, counts_per_mm, family) {first, last, counts_per_mm},
#include "drivers/tablet/models.inl"
#undef TABLET_MODELS
};

std::int32_t counts_per_mm(std::uint16_t product) {
  for (const Models& m : models)
    if (product >= m.first_product && product <= m.last_product) return m.counts_per_mm;
  return wacom_counts_per_mm;
}

Millimetres length(const AxisRange& axis, std::int32_t counts_per_millimetre) {
  return Millimetres((static_cast<double>(axis.maximum) - axis.minimum) / counts_per_millimetre);
}

struct Size {
  Millimetres width;
  Millimetres height;
};

// How well a row of libwacom's fits; makers share product numbers, so it may ask for the name too.
enum class Fit { none, number, number_and_name };

Fit fit(const WacomDevice* row, const DeviceDescription& device) {
  Fit best = Fit::none;
  const WacomMatch* const* match = libwacom_get_matches(row);
  for (; match != nullptr && *match != nullptr; ++match) {
    if (libwacom_match_get_vendor_id(*match) != device.vendor ||
        libwacom_match_get_product_id(*match) != device.product)
      continue;
    const char* name = libwacom_match_get_name(*match);
    if (name != nullptr && device.name == name) return Fit::number_and_name;
    if (name == nullptr) best = Fit::number;
  }
  return best;
}

// From the row that fits best; libwacom keeps whole inches.
std::optional<Size> libwacom_size(const DeviceDescription& device) {
  constexpr double mm_per_inch = 25.4;
  const std::unique_ptr<WacomDeviceDatabase, decltype(&libwacom_database_destroy)> database(
      libwacom_database_new(), libwacom_database_destroy);
  if (!database) return std::nullopt;
  const std::unique_ptr<WacomDevice*, decltype(&std::free)> rows(
      libwacom_list_devices_from_database(database.get(), nullptr), std::free);
  Fit best = Fit::none;
  std::optional<Size> size;
  for (WacomDevice** row = rows.get(); row != nullptr && *row != nullptr; ++row) {
    const int width = libwacom_get_width(*row);
    const int height = libwacom_get_height(*row);
    const Fit fits = fit(*row, device);
    if (width <= 0 || height <= 0 || fits <= best) continue;
    best = fits;
    size = Size{Millimetres(width * mm_per_inch), Millimetres(height * mm_per_inch)};
  }
  return size;
}

std::optional<Size> active_area(const DeviceDescription& device, const AxisRange& x, const AxisRange& y) {
  if (x.resolution > 0 && y.resolution > 0) return Size{length(x, x.resolution), length(y, y.resolution)};
  if (device.vendor == wacom) {
    const std::int32_t density = counts_per_mm(device.product);
    return Size{length(x, density), length(y, density)};
  }
  return libwacom_size(device);
}

}  // namespace

bool is_pen_tablet(const DeviceDescription& device) {
  if (find_axis(device, ABS_X) == nullptr || find_axis(device, ABS_Y) == nullptr) return false;
  for (std::uint16_t key : pen_tool_keys)
    if (has_key(device, key)) return true;
  const bool fingers = has_key(device, BTN_TOOL_FINGER) || find_axis(device, ABS_MT_POSITION_X) != nullptr;
  return !fingers && find_axis(device, ABS_PRESSURE) != nullptr && has_key(device, BTN_TOUCH);
}

DeviceDescription identified(DeviceDescription device) {
  if (!is_pen_tablet(device)) return device;
  device.kind = DeviceKind::pen_tablet;
  const AxisRange& x = *find_axis(device, ABS_X);
  const AxisRange& y = *find_axis(device, ABS_Y);
  if (!usable(&x) || !usable(&y)) return device;
  if (const auto size = active_area(device, x, y)) {
    device.width = size->width;
    device.height = size->height;
  }
  return device;
}

std::vector<std::string> capabilities(const DeviceDescription& device) {
  const auto axis = [&](std::uint16_t code) { return find_axis(device, code) != nullptr; };
  const bool pen = is_pen_tablet(device);
  const std::pair<bool, const char*> all[] = {
      {axis(ABS_X), "x"},
      {axis(ABS_Y), "y"},
      {axis(ABS_PRESSURE), "pressure"},
      {axis(ABS_TILT_X) && axis(ABS_TILT_Y), "tilt"},
      {pen && axis(ABS_Z), "rotation"},
      {axis(ABS_DISTANCE), "distance"},
      {pen && axis(ABS_WHEEL), "wheel"},
      {has_key(device, BTN_TOOL_RUBBER), "eraser"},
  };
  std::vector<std::string> sensed;
  for (const auto& [present, name] : all)
    if (present) sensed.emplace_back(name);
  return sensed;
}

}  // namespace fude
