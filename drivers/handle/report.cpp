#include "drivers/handle/report.h"

#include <algorithm>
#include <cmath>

#include "drivers/crc16.h"

namespace fude::handle {
namespace {

constexpr std::int16_t no_temperature = INT16_MIN;
constexpr std::uint8_t no_battery = 0xff;
constexpr std::size_t serial_length = 16;
constexpr std::uint8_t magnetic_field_flag = 1;
constexpr std::uint8_t failed_flag = 2;

bool stands(Bytes report, std::uint8_t number, std::size_t length) {
  return report.size() == length && octet(report, 0) == number && octet(report, 1) == protocol_version &&
         crc16_holds(report);
}

std::array<std::int16_t, 3> three(Bytes report, std::size_t at) {
  return {little_endian<std::int16_t>(report, at), little_endian<std::int16_t>(report, at + 2),
          little_endian<std::int16_t>(report, at + 4)};
}

}  // namespace

std::optional<Motion> read_motion(Bytes report) {
  if (!stands(report, motion_number, motion_length)) return std::nullopt;
  Motion motion;
  motion.sequence = little_endian<std::uint16_t>(report, 2);
  motion.tick_us = little_endian<std::uint32_t>(report, 4);
  motion.turn_rate = three(report, 8);
  motion.specific_force = three(report, 14);
  motion.magnetic_field = three(report, 20);
  const auto hundredths = little_endian<std::int16_t>(report, 26);
  if (hundredths != no_temperature) motion.temperature_c = hundredths / 100.0;
  motion.buttons = octet(report, 28);
  motion.magnetic_field_is_new = (octet(report, 29) & magnetic_field_flag) != 0;
  motion.measured = (octet(report, 29) & failed_flag) == 0;
  if (const std::uint8_t percent = octet(report, 30); percent <= 100) motion.battery = percent / 100.0;
  return motion;
}

std::optional<Scale> read_scale(Bytes report) {
  if (!stands(report, scale_number, scale_length)) return std::nullopt;
  Scale scale;
  scale.turn_rate_degps = little_endian<std::uint16_t>(report, 2);
  scale.specific_force_mg = little_endian<std::uint16_t>(report, 4);
  scale.magnetic_field_ut = little_endian<std::uint16_t>(report, 6);
  scale.rate_hz = little_endian<std::uint16_t>(report, 8);
  scale.firmware_major = octet(report, 10);
  scale.firmware_minor = octet(report, 11);
  scale.buttons = octet(report, 12);
  scale.has_magnetometer = (octet(report, 13) & 1) != 0;
  for (std::size_t i = 0; i < serial_length; ++i) {
    const char c = static_cast<char>(octet(report, 14 + i));
    if (c == 0) break;
    if (c < 0x21 || c > 0x7e) return std::nullopt;
    scale.serial.push_back(c);
  }
  if (scale.turn_rate_degps == 0 || scale.specific_force_mg == 0) return std::nullopt;
  if (scale.has_magnetometer && scale.magnetic_field_ut == 0) return std::nullopt;
  return scale;
}

std::vector<std::byte> write_motion(const Motion& motion) {
  auto report = octets({motion_number, protocol_version});
  put_little_endian(report, motion.sequence);
  put_little_endian(report, motion.tick_us);
  for (const auto* axes : {&motion.turn_rate, &motion.specific_force, &motion.magnetic_field})
    for (std::int16_t axis : *axes) put_little_endian(report, axis);
  put_little_endian(report, motion.temperature_c
                                ? static_cast<std::int16_t>(std::lround(*motion.temperature_c * 100))
                                : no_temperature);
  report.push_back(static_cast<std::byte>(motion.buttons));
  report.push_back(static_cast<std::byte>((motion.magnetic_field_is_new ? magnetic_field_flag : 0) |
                                          (motion.measured ? 0 : failed_flag)));
  report.push_back(
      static_cast<std::byte>(motion.battery ? std::lround(*motion.battery * 100) : long{no_battery}));
  report.push_back(std::byte{0});
  put_crc16(report);
  return report;
}

std::vector<std::byte> write_scale(const Scale& scale) {
  auto report = octets({scale_number, protocol_version});
  for (std::uint16_t value :
       {scale.turn_rate_degps, scale.specific_force_mg, scale.magnetic_field_ut, scale.rate_hz})
    put_little_endian(report, value);
  for (std::uint8_t value : {scale.firmware_major, scale.firmware_minor, scale.buttons,
                             static_cast<std::uint8_t>(scale.has_magnetometer ? 1 : 0)})
    report.push_back(static_cast<std::byte>(value));
  for (std::size_t i = 0; i < serial_length; ++i)
    report.push_back(i < scale.serial.size() ? static_cast<std::byte>(scale.serial[i]) : std::byte{0});
  put_crc16(report);
  return report;
}

}  // namespace fude::handle
