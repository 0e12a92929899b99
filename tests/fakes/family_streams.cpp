#include "tests/fakes/family_streams.h"

#include <linux/input-event-codes.h>

#include <bit>
#include <cmath>
#include <utility>

#include "drivers/byte_order.h"
#include "drivers/falcon/falcon_decoder.h"
#include "drivers/falcon/ftdi.h"
#include "drivers/handle/handle_decoder.h"
#include "drivers/joycon/joycon_decoder.h"
#include "drivers/openigtlink/content.h"
#include "drivers/openigtlink/openigtlink_decoder.h"
#include "drivers/p5glove/p5glove_decoder.h"
#include "drivers/polhemus/polhemus_decoder.h"
#include "drivers/spacemouse/spacemouse_decoder.h"
#include "drivers/tablet/hid_pen_decoder.h"
#include "drivers/tablet/tablet_decoder.h"
#include "drivers/touch/touch_decoder.h"
#include "drivers/ultrasonic/ultrasonic_decoder.h"
#include "drivers/vrpn/message.h"
#include "drivers/vrpn/vrpn_decoder.h"
#include "tests/fakes/transfers.h"

namespace fude {
namespace {

constexpr int report_ms = 4;

std::int16_t small(unsigned i, unsigned factor) {
  return static_cast<std::int16_t>(static_cast<int>(i * factor % 200) - 100);
}

std::vector<Transfer> repeated(unsigned count, TransferKind kind, std::uint8_t endpoint,
                               const std::function<std::vector<std::byte>(unsigned)>& report) {
  std::vector<Transfer> all;
  for (unsigned i = 0; i < count; ++i) {
    all.push_back(from_device(kind, report(i), report_ms * static_cast<int>(i + 1)));
    all.back().endpoint = endpoint;
  }
  return all;
}

Pose<Tracker, Tool> pose_at(unsigned i) {
  const double half_turn = 0.01 * i;
  return {Eigen::Quaterniond(std::cos(half_turn), 0, 0, std::sin(half_turn)),
          Eigen::Vector3d(0.001 * i, -0.2, 0.3)};
}

DeviceDescription tablet() {
  DeviceDescription device;
  device.transport = "evdev";
  device.keys = {BTN_TOOL_PEN, BTN_TOUCH};
  device.axes = {{.code = ABS_X, .maximum = 10000},
                 {.code = ABS_Y, .maximum = 10000},
                 {.code = ABS_PRESSURE, .maximum = 1023}};
  return device;
}

DeviceDescription raw_pen(std::uint16_t vendor, std::uint16_t product,
                          std::vector<std::byte> descriptor = {}) {
  DeviceDescription device;
  device.transport = "hidraw";
  device.vendor = vendor;
  device.product = product;
  device.hid_descriptor = std::move(descriptor);
  return device;
}

DeviceDescription touch_surface() {
  DeviceDescription device;
  device.transport = "evdev";
  device.keys = {BTN_TOUCH};
  device.axes = {{.code = ABS_MT_SLOT, .maximum = 9},
                 {.code = ABS_MT_POSITION_X, .maximum = 4000},
                 {.code = ABS_MT_POSITION_Y, .maximum = 3000},
                 {.code = ABS_MT_TRACKING_ID, .maximum = 65535}};
  return device;
}

// Its tower's calibration: no correction, heads 7.9 inches apart.
std::vector<Transfer> glove_tower() {
  std::vector<Transfer> answers{from_device(TransferKind::hid_feature, from_hex("06 00 00 00 00 4f"))};
  for (const unsigned kind : {0u, 1u}) {
    auto lights = octets({12, kind});
    lights.resize(62);
    answers.push_back(from_device(TransferKind::hid_feature, std::move(lights)));
  }
  return answers;
}

}  // namespace

std::vector<std::byte> handle_scale() {
  handle::Scale scale;
  scale.turn_rate_degps = 2000;
  scale.specific_force_mg = 16000;
  scale.magnetic_field_ut = 1000;
  scale.rate_hz = 1000;
  scale.firmware_major = 1;
  scale.buttons = 2;
  scale.serial = "H007";
  return handle::write_scale(scale);
}

std::vector<std::byte> handle_motion(unsigned i) {
  handle::Motion motion;
  motion.sequence = static_cast<std::uint16_t>(i);
  motion.tick_us = 1000 * i;
  motion.turn_rate = {small(i, 3), small(i, 5), small(i, 7)};
  motion.specific_force = {small(i, 11), small(i, 13), 2048};
  motion.buttons = static_cast<std::uint8_t>(i / 16 % 4);
  return handle::write_motion(motion);
}

std::vector<std::byte> spacemouse_motion(unsigned i) {
  auto report = octets({1});
  for (const unsigned factor : {3u, 5u, 7u, 11u, 13u, 17u})
    put_little_endian(report, static_cast<std::uint16_t>(small(i, factor)));
  return report;
}

std::vector<std::byte> patriot_record(unsigned i) {
  auto record = octets({'P', 'A', 1, 'C', ' ', 0});
  put_little_endian(record, std::uint16_t{44});
  for (const std::uint32_t word : {16 * i, i, 1u, 3u}) put_little_endian(record, word);
  const double half_turn = 0.01 * i;
  for (const double value : {10 + 0.1 * i, -20.0, 30.0, std::cos(half_turn), 0.0, 0.0, std::sin(half_turn)})
    put_little_endian(record, std::bit_cast<std::uint32_t>(static_cast<float>(value)));
  return record;
}

std::vector<std::byte> falcon_answer(unsigned i) {
  falcon::FromArm message;
  message.encoders = {small(i, 3), small(i, 5), small(i, 7)};
  message.homed = 7;
  message.buttons = static_cast<std::uint8_t>(i / 8 % 16);
  return falcon::write_from_arm(message);
}

std::vector<std::byte> ultrasonic_pulse(unsigned i) {
  ultrasonic::Pulse pulse;
  pulse.sequence = static_cast<std::uint16_t>(i);
  pulse.tick_us = 20'000 * i;
  pulse.temperature_c = 22;
  pulse.receivers = 3;
  for (unsigned r = 0; r < pulse.receivers; ++r) {
    pulse.flight_ns[r] = 1'000'000 + 1000 * i + 100'000 * r;
    pulse.amplitude[r] = 0x8000;
  }
  return ultrasonic::framed(ultrasonic::write_pulse(pulse));
}

std::vector<std::byte> joycon_report(unsigned i) {
  auto report = octets({0x30, 3 * i & 0xff, 0x91, 0x08, 0x01, 0x40, 0, 0, 0, 0, 0, 0, 0xa0});
  for (unsigned reading = 0; reading < 3; ++reading)
    for (const int value : {int{small(i, 3)}, 4096, int{small(i, 5)}, 100, 200, int{small(i, 7)}})
      put_little_endian(report, static_cast<std::uint16_t>(value));
  return report;
}

std::vector<std::byte> glove_report(unsigned i) {
  std::vector<bool> bits;
  const auto put = [&bits](unsigned value, int width) {
    for (int bit = width - 1; bit >= 0; --bit) bits.push_back(value >> bit & 1);
  };
  constexpr unsigned unseen = 15;
  put(1, 8);
  for (const unsigned bend : {10u, 20u, 30u, 40u, i % 64}) put(bend, 6);
  put(0, 2);
  put(5, 4);
  for (const unsigned light : {2u, unseen, unseen, unseen}) put(light, 4);
  for (const unsigned tangent : {20u, 10u, i}) put(tangent, 10);
  std::vector<std::byte> report(p5glove::report_length);
  for (std::size_t bit = 0; bit < bits.size(); ++bit)
    if (bits[bit]) report[bit / 8] |= static_cast<std::byte>(0x80 >> bit % 8);
  return report;
}

std::vector<std::byte> intuos_enter() { return octets({2, 0xc2, 0x80, 0x22, 0x48, 0x10, 0xf7, 0x31, 0, 0}); }

std::vector<std::byte> intuos_report(unsigned i) {
  return octets({2, 0xe1, 0x20, i % 256, 0x10, 0x9d, 20 + i % 200, 0x1b, 0x55, 0x61});
}

std::vector<std::byte> huion_report(unsigned i) {
  return octets({8, 0x81, i % 256, 0x46, 0x06, 0x3c, i % 256, 0x0f, 0, 0, 0x10, 0xf0});
}

// Tip, barrel, eraser, invert and in range; x and y of 10000 to ten centimetres; pressure; tilt.
std::vector<std::byte> standard_pen_descriptor() {
  return octets({0x05, 0x0d, 0x09, 0x02, 0xa1, 0x01, 0x85, 0x07, 0x09, 0x20, 0xa1, 0x00, 0x09, 0x42, 0x09,
                 0x44, 0x09, 0x45, 0x09, 0x3c, 0x09, 0x32, 0x15, 0x00, 0x25, 0x01, 0x75, 0x01, 0x95, 0x05,
                 0x81, 0x02, 0x95, 0x03, 0x81, 0x03, 0x05, 0x01, 0x09, 0x30, 0x09, 0x31, 0x55, 0x0e, 0x65,
                 0x11, 0x35, 0x00, 0x46, 0xe8, 0x03, 0x26, 0x10, 0x27, 0x75, 0x10, 0x95, 0x02, 0x81, 0x02,
                 0x65, 0x00, 0x05, 0x0d, 0x09, 0x30, 0x26, 0xff, 0x1f, 0x95, 0x01, 0x81, 0x02, 0x09, 0x3d,
                 0x09, 0x3e, 0x15, 0xc4, 0x25, 0x3c, 0x75, 0x08, 0x95, 0x02, 0x81, 0x02, 0xc0, 0xc0});
}

std::vector<std::byte> standard_pen_report(unsigned i) {
  return octets({7, 0x11, i % 256, 0x13, 0x10, 0x17, i % 256, 0x0f, 0x1e, 0xe2});
}

std::vector<std::byte> pen_frame(unsigned i) {
  std::vector<EvdevEvent> events;
  if (i == 0) events = {{EV_KEY, BTN_TOOL_PEN, 1}, {EV_KEY, BTN_TOUCH, 1}};
  events.push_back({EV_ABS, ABS_X, static_cast<std::int32_t>(100 + i)});
  events.push_back({EV_ABS, ABS_PRESSURE, static_cast<std::int32_t>(1 + i)});
  events.push_back({EV_SYN, SYN_REPORT, 0});
  return pack_events(events);
}

std::vector<std::byte> touch_frame(unsigned i) {
  std::vector<EvdevEvent> events;
  if (i == 0) events = {{EV_ABS, ABS_MT_SLOT, 0}, {EV_ABS, ABS_MT_TRACKING_ID, 7}};
  events.push_back({EV_ABS, ABS_MT_POSITION_X, static_cast<std::int32_t>(100 + i)});
  events.push_back({EV_ABS, ABS_MT_POSITION_Y, static_cast<std::int32_t>(200 + i)});
  events.push_back({EV_SYN, SYN_REPORT, 0});
  return pack_events(events);
}

std::vector<std::byte> transform_message(unsigned i) {
  return openigtlink::write_transform("Brush", openigtlink::stamp_of_us(1000 * (i + 1)), pose_at(i));
}

std::vector<std::byte> pos_quat_message(unsigned i) {
  return vrpn::write_message(
      {.time_us = 1000 * (i + 1), .sender = 0, .type = 0, .body = vrpn::write_pose({0, pose_at(i)})});
}

std::vector<FamilyStream> family_streams(unsigned count) {
  const auto behind_status = [](unsigned i) {
    auto packet = octets({0x01, 0x60});
    append(packet, falcon_answer(i));
    return packet;
  };
  std::vector<FamilyStream> all;
  all.push_back({"brush handle",
                 [] { return std::make_unique<HandleDecoder>(); },
                 {from_device(TransferKind::hid_feature, handle_scale())},
                 repeated(count, TransferKind::hid_report, 0, handle_motion),
                 false});
  all.push_back({"SpaceMouse",
                 [] { return std::make_unique<SpaceMouseDecoder>(0x256f, 0xc632); },
                 {},
                 repeated(count, TransferKind::hid_report, 0, spacemouse_motion),
                 false});
  all.push_back({"PATRIOT",
                 [] { return std::make_unique<PolhemusDecoder>(0xef12, true); },
                 {},
                 repeated(count, TransferKind::usb_bulk, 0x88, patriot_record),
                 true});
  all.push_back({"PATRIOT on a serial line",
                 [] { return std::make_unique<PolhemusDecoder>(0xef12, false); },
                 {},
                 repeated(count, TransferKind::serial, 0, patriot_record),
                 true});
  all.push_back({"Falcon",
                 [] { return std::make_unique<FalconDecoder>(); },
                 {},
                 repeated(count, TransferKind::usb_bulk, falcon::bulk_in, behind_status),
                 false});
  all.push_back({"ultrasonic board",
                 [] { return std::make_unique<UltrasonicDecoder>(); },
                 {},
                 repeated(count, TransferKind::serial, 0, ultrasonic_pulse),
                 true});
  all.push_back({.name = "Joy-Con",
                 .decoder = [] { return std::make_unique<JoyconDecoder>(); },
                 .reports = repeated(count, TransferKind::hid_report, 0, joycon_report),
                 .samples = 3});
  all.push_back({.name = "P5 Glove",
                 .decoder = [] { return std::make_unique<P5GloveDecoder>(); },
                 .introduction = glove_tower(),
                 .reports = repeated(count, TransferKind::hid_report, 0, glove_report)});
  all.push_back({.name = "pen tablet",
                 .decoder = [] { return std::make_unique<TabletDecoder>(tablet()); },
                 .reports = repeated(count, TransferKind::evdev_frame, 0, pen_frame),
                 .from_kernel = true});
  all.push_back({.name = "Intuos Pro, raw",
                 .decoder = [] { return std::make_unique<HidPenDecoder>(raw_pen(0x056a, 0x0314)); },
                 .introduction = {from_device(TransferKind::hid_report, intuos_enter())},
                 .reports = repeated(count, TransferKind::hid_report, 0, intuos_report)});
  all.push_back({.name = "Huion, raw",
                 .decoder = [] { return std::make_unique<HidPenDecoder>(raw_pen(0x256c, 0x006d)); },
                 .reports = repeated(count, TransferKind::hid_report, 0, huion_report)});
  all.push_back(
      {.name = "standard pen, raw",
       .decoder =
           [] { return std::make_unique<HidPenDecoder>(raw_pen(0x28bd, 0x0904, standard_pen_descriptor())); },
       .reports = repeated(count, TransferKind::hid_report, 0, standard_pen_report)});
  all.push_back({.name = "touch surface",
                 .decoder = [] { return std::make_unique<TouchDecoder>(touch_surface()); },
                 .reports = repeated(count, TransferKind::evdev_frame, 0, touch_frame),
                 .from_kernel = true});
  all.push_back({.name = "OpenIGTLink",
                 .decoder = [] { return std::make_unique<OpenIgtLinkDecoder>(); },
                 .reports = repeated(count, TransferKind::message, 0, transform_message)});
  all.push_back(
      {.name = "VRPN",
       .decoder = [] { return std::make_unique<VrpnDecoder>(); },
       .introduction = {from_device(TransferKind::message, vrpn::write_cookie()),
                        from_device(TransferKind::message,
                                    vrpn::write_description(vrpn::sender_description, 0, "Brush")),
                        from_device(TransferKind::message,
                                    vrpn::write_description(vrpn::type_description, 0, vrpn::pose_type))},
       .reports = repeated(count, TransferKind::message, 0, pos_quat_message)});
  return all;
}

}  // namespace fude
