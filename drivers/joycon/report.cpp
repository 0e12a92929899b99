#include "drivers/joycon/report.h"

namespace fude::joycon {
namespace {

constexpr std::uint8_t reply_number = 0x21;
constexpr std::uint8_t simple_number = 0x3f;
constexpr std::uint8_t read_flash = 0x10;

// The upper nibble of byte 2 is twice the level, 0 to 4, and bit 0 says that it is being charged.
std::optional<Head> read_head(Bytes report) {
  const unsigned level = octet(report, 2) >> 4;
  if (level > 9) return std::nullopt;
  Head head;
  head.timer = octet(report, 1);
  head.battery = (level >> 1) / 4.0;
  head.charging = (level & 1) != 0;
  for (std::size_t i = 0; i < 3; ++i) head.buttons |= std::uint32_t{octet(report, 3 + i)} << (8 * i);
  return head;
}

}  // namespace

ReportKind kind_of(Bytes report) {
  if (report.empty()) return ReportKind::other;
  const std::uint8_t number = octet(report, 0);
  if (number >= 0x30 && number <= 0x33) return ReportKind::full;
  if (number == reply_number) return ReportKind::reply;
  return number == simple_number ? ReportKind::simple : ReportKind::other;
}

std::optional<FullReport> read_full_report(Bytes report) {
  if (report.size() < report_length || kind_of(report) != ReportKind::full) return std::nullopt;
  const auto head = read_head(report);
  if (!head) return std::nullopt;
  FullReport full{.head = *head};
  std::size_t at = 13;
  for (InertialCounts& sample : full.samples)
    for (auto* axes : {&sample.acceleration, &sample.turn_rate})
      for (std::int16_t& axis : *axes) {
        axis = little_endian<std::int16_t>(report, at);
        at += 2;
      }
  return full;
}

std::optional<Reply> read_reply(Bytes report) {
  if (report.size() < report_length || kind_of(report) != ReportKind::reply) return std::nullopt;
  const auto head = read_head(report);
  if (!head) return std::nullopt;
  return Reply{*head, (octet(report, 13) & 0x80) != 0, octet(report, 14),
               report.subspan(15, report_length - 15)};
}

std::vector<std::byte> subcommand(std::uint8_t counter, std::uint8_t number, Bytes arguments) {
  auto report = octets({0x01, counter & 0x0fu, 0x00, 0x01, 0x40, 0x40, 0x00, 0x01, 0x40, 0x40, number});
  append(report, arguments);
  report.resize(report_length);
  return report;
}

std::vector<std::byte> flash_question(std::uint32_t address, std::uint8_t length) {
  std::vector<std::byte> arguments;
  put_little_endian(arguments, address);
  put_little_endian(arguments, length);
  return arguments;
}

std::optional<Bytes> flash_answer(const Reply& reply, std::uint32_t address, std::uint8_t length) {
  if (!reply.acknowledged || reply.subcommand != read_flash || reply.data.size() < std::size_t{5} + length ||
      little_endian<std::uint32_t>(reply.data, 0) != address || octet(reply.data, 4) != length)
    return std::nullopt;
  return reply.data.subspan(5, length);
}

}  // namespace fude::joycon
