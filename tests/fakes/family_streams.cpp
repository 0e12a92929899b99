#include "tests/fakes/family_streams.h"

#include <bit>
#include <cmath>
#include <utility>

#include "drivers/byte_order.h"
#include "drivers/falcon/falcon_decoder.h"
#include "drivers/falcon/ftdi.h"
#include "drivers/handle/handle_decoder.h"
#include "drivers/polhemus/polhemus_decoder.h"
#include "drivers/spacemouse/spacemouse_decoder.h"
#include "drivers/ultrasonic/ultrasonic_decoder.h"
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
  return all;
}

}  // namespace fude
