#include "drivers/families.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "drivers/camera/camera_decoder.h"
#include "drivers/falcon/falcon_decoder.h"
#include "drivers/handle/handle_decoder.h"
#include "drivers/joycon/joycon_decoder.h"
#include "drivers/openigtlink/openigtlink_decoder.h"
#include "drivers/p5glove/p5glove_decoder.h"
#include "drivers/polhemus/polhemus_decoder.h"
#include "drivers/spacemouse/spacemouse_decoder.h"
#include "drivers/tablet/identify.h"
#include "drivers/tablet/tablet_decoder.h"
#include "drivers/touch/touch_decoder.h"
#include "drivers/ultrasonic/ultrasonic_decoder.h"
#include "drivers/vrpn/vrpn_decoder.h"

namespace fude {
namespace {

constexpr std::uint16_t nintendo = 0x057e;
constexpr std::uint16_t polhemus_vendor = 0x0f44;
constexpr std::uint16_t ftdi_vendor = 0x0403;
constexpr HidUsage multi_axis_controller{0x01, 0x08};
constexpr HidUsage brush_handle{0xff00, 0x01};

constexpr FamilyRow rows[] = {
    {Family::tablet, "tablet", DeviceKind::pen_tablet, "evdev", 0, 0, {}, "pen tablet"},
    {Family::touch, "touch", DeviceKind::touch, "evdev", 0, 0, {}, "touch surface"},
#define JOYCON_MODEL(product, name, acceleration_g, turn_rate_degps) \
  {Family::joycon, "joycon", DeviceKind::imu, "hidraw", nintendo, product, {}, name},
#include "drivers/joycon/models.inl"
#undef JOYCON_MODEL
#define SPACEMOUSE_MODEL(vendor, product, name, buttons, range_counts)               \
  {Family::spacemouse,    "spacemouse", DeviceKind::puck, "hidraw", vendor, product, \
   multi_axis_controller, name},
#include "drivers/spacemouse/models.inl"
#undef SPACEMOUSE_MODEL
    // The kernel's HID driver leaves the glove alone: live it is read over libusb, as reports all the same.
    {Family::p5glove, "p5glove", DeviceKind::glove, "usb", 0x0d7f, 0x0100, {}, "P5 Glove"},
    {Family::p5glove, "p5glove", DeviceKind::glove, "hidraw", 0x0d7f, 0x0100, {}, "P5 Glove"},
    {Family::handle, "handle", DeviceKind::imu, "hidraw", 0x1209, 0x0001, brush_handle, "fude brush handle"},
    {Family::ultrasonic,
     "ultrasonic",
     DeviceKind::ultrasonic,
     "serial",
     0x1209,
     0x0002,
     {},
     "fude ultrasonic"},
    {Family::ultrasonic, "ultrasonic", DeviceKind::ultrasonic, "serial", 0, 0, {}, "fude ultrasonic"},
#define POLHEMUS_MODEL(product, name, dialect, stations, in, out) \
  {Family::polhemus, "polhemus", DeviceKind::tracker, "usb", polhemus_vendor, product, {}, name},
#include "drivers/polhemus/models.inl"
#undef POLHEMUS_MODEL
    {Family::polhemus, "fastrak", DeviceKind::tracker, "serial", 0, 0x0002, {}, "FASTRAK"},
    {Family::polhemus, "patriot", DeviceKind::tracker, "serial", 0, 0xef12, {}, "PATRIOT"},
    {Family::polhemus, "liberty", DeviceKind::tracker, "serial", 0, 0xff12, {}, "LIBERTY"},
#define FALCON_MODEL(product, name, force_n, motor_counts_per_nm, motor_limit_counts, middle_m) \
  {Family::falcon, "falcon", DeviceKind::haptic, "usb", ftdi_vendor, product, {}, name},
#include "drivers/falcon/models.inl"
#undef FALCON_MODEL
    {Family::openigtlink, "openigtlink", DeviceKind::tracker, "network", 0, 0, {}, "OpenIGTLink"},
    {Family::vrpn, "vrpn", DeviceKind::tracker, "network", 0, 0, {}, "VRPN"},
    {Family::camera, "camera", DeviceKind::camera, "v4l2", 0, 0, {}, "camera"},
};

template <class Fits>
const FamilyRow* first(Fits&& fits) {
  const auto* row = std::find_if(std::begin(rows), std::end(rows), fits);
  return row == std::end(rows) ? nullptr : row;
}

}  // namespace

std::span<const FamilyRow> family_rows() { return rows; }

const FamilyRow* find_family(const DeviceDescription& device, std::optional<HidUsage> usage) {
  if (device.transport == "evdev") {
    if (is_pen_tablet(device)) return find_family("tablet", "evdev");
    return is_touch_surface(device) ? find_family("touch", "evdev") : nullptr;
  }
  if (device.transport == "v4l2") return find_family("camera", "v4l2");
  if (device.vendor == 0)
    return first([&](const FamilyRow& row) {
      return row.vendor == 0 && device.transport == row.transport &&
             device.name.starts_with(name_at(row, ""));
    });
  return first([&](const FamilyRow& row) {
    return device.transport == row.transport && device.vendor == row.vendor &&
           device.product == row.product && (!usage || !row.usage || *usage == *row.usage);
  });
}

std::string name_at(const FamilyRow& row, std::string_view where) {
  return std::string(row.model) + " at " + std::string(where);
}

const FamilyRow* find_family(std::string_view word, std::string_view transport) {
  return first([&](const FamilyRow& row) { return word == row.word && transport == row.transport; });
}

std::unique_ptr<Decoder> open_decoder(const FamilyRow& row, const DeviceDescription& device,
                                      std::vector<std::byte> firmware) {
  switch (row.family) {
    case Family::tablet:
      return std::make_unique<TabletDecoder>(device);
    case Family::touch:
      return std::make_unique<TouchDecoder>(device);
    case Family::joycon:
      return std::make_unique<JoyconDecoder>(row.product);
    case Family::spacemouse:
      return std::make_unique<SpaceMouseDecoder>(row.vendor, row.product);
    case Family::p5glove:
      return std::make_unique<P5GloveDecoder>();
    case Family::handle:
      return std::make_unique<HandleDecoder>();
    case Family::polhemus:
      return std::make_unique<PolhemusDecoder>(row.product, std::string_view(row.transport) == "usb");
    case Family::ultrasonic:
      return std::make_unique<UltrasonicDecoder>();
    case Family::openigtlink:
      return std::make_unique<OpenIgtLinkDecoder>();
    case Family::vrpn:
      return std::make_unique<VrpnDecoder>();
    case Family::camera:
      return std::make_unique<CameraDecoder>();
    case Family::falcon:
      return std::make_unique<FalconDecoder>(std::move(firmware));
  }
  throw std::logic_error("a family without a decoder");
}

}  // namespace fude
