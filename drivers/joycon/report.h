// The reports of a Joy-Con as they stand on the wire (firmware-notes/joycon.md).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "drivers/byte_order.h"

namespace fude::joycon {

inline constexpr std::size_t report_length = 49;
inline constexpr std::size_t samples_per_report = 3;

enum class ReportKind : std::uint8_t { full, reply, simple, other };

// By the first byte: full 0x30 to 0x33 (with the inertial unit), reply 0x21, simple 0x3f.
ReportKind kind_of(Bytes report);

struct InertialCounts {
  std::array<std::int16_t, 3> acceleration{};
  std::array<std::int16_t, 3> turn_rate{};
};

// What full reports and replies have in common.
struct Head {
  std::uint8_t timer = 0;  // 5 ms a count
  double battery = 0;      // 0 empty, 1 full
  bool charging = false;
  std::uint32_t buttons = 0;  // bits 0 to 7 right, 8 to 15 shared, 16 to 23 left
};

struct FullReport {
  Head head;
  std::array<InertialCounts, samples_per_report> samples{};  // oldest first, 5 ms apart
};

struct Reply {
  Head head;
  bool acknowledged = false;
  std::uint8_t subcommand = 0;
  Bytes data;  // into the report
};

// None where the bytes are too few, the number is another, or the battery's nibble has no meaning.
std::optional<FullReport> read_full_report(Bytes report);
std::optional<Reply> read_reply(Bytes report);

// The output report that asks for one thing, with still motors. `counter` goes round in 0 to 15.
std::vector<std::byte> subcommand(std::uint8_t counter, std::uint8_t number, Bytes arguments);

// Arguments of subcommand 0x10, and the bytes of its answer where it is one to this very question.
std::vector<std::byte> flash_question(std::uint32_t address, std::uint8_t length);
std::optional<Bytes> flash_answer(const Reply& reply, std::uint32_t address, std::uint8_t length);

}  // namespace fude::joycon
