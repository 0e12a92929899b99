#include "tests/lab/pen_reports.h"

#include <initializer_list>

namespace fude::lab {
namespace {

std::uint32_t at(const Bytes& report, std::size_t index) {
  return std::to_integer<std::uint32_t>(report.at(index));
}

std::int32_t little_endian(const Bytes& report, std::size_t index, std::size_t width) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < width; ++i) value |= at(report, index + i) << (8 * i);
  return static_cast<std::int32_t>(value);
}

void put(Bytes& report, std::size_t index, std::size_t width, std::int32_t value) {
  for (std::size_t i = 0; i < width; ++i)
    report.at(index + i) = static_cast<std::byte>(static_cast<std::uint32_t>(value) >> (8 * i));
}

Bytes bytes(std::initializer_list<unsigned> values) {
  Bytes out;
  for (const unsigned value : values) out.push_back(static_cast<std::byte>(value));
  return out;
}

constexpr unsigned tip = 1;

}  // namespace

std::optional<PenReport> intuos_report(const Bytes& r) {
  if (r.size() != 10 || (at(r, 0) != 0x02 && at(r, 0) != 0x10) || (at(r, 1) & 0xf8) != 0xe0)
    return std::nullopt;
  PenReport pen;
  pen.x = static_cast<std::int32_t>(at(r, 2) << 9 | at(r, 3) << 1 | (at(r, 9) >> 1 & 1));
  pen.y = static_cast<std::int32_t>(at(r, 4) << 9 | at(r, 5) << 1 | (at(r, 9) & 1));
  pen.pressure = static_cast<std::int32_t>(at(r, 6) << 3 | (at(r, 7) & 0xc0) >> 5 | (at(r, 1) & 1));
  pen.tilt_x = static_cast<std::int32_t>((at(r, 7) << 1 & 0x7e) | at(r, 8) >> 7) - 64;
  pen.tilt_y = static_cast<std::int32_t>(at(r, 8) & 0x7f) - 64;
  return pen;
}

// Number 0x10: flags, x and y of 24 bits, pressure of 16, two tilts, turn, …, serial, tool type.
Bytes cintiq_pro_report(const PenReport& pen) {
  constexpr unsigned in_range = 1 << 5;
  constexpr unsigned near = 1 << 6;  // Wacom's "sense"
  Bytes r(27);
  put(r, 0, 1, 0x10);
  if (!pen.near) return r;
  put(r, 1, 1, static_cast<std::int32_t>((pen.pressure > 0 ? tip : 0) | in_range | near));
  put(r, 2, 3, pen.x);
  put(r, 5, 3, pen.y);
  put(r, 8, 2, pen.pressure);
  put(r, 10, 1, pen.tilt_x);
  put(r, 11, 1, pen.tilt_y);
  put(r, 17, 4, 0x12345678);
  put(r, 25, 2, 0x0842);
  return r;
}

std::optional<PenReport> read_cintiq_pro_report(const Bytes& r) {
  if ((at(r, 1) & 1 << 5) == 0) return std::nullopt;
  PenReport pen;
  pen.x = little_endian(r, 2, 3);
  pen.y = little_endian(r, 5, 3);
  pen.pressure = little_endian(r, 8, 2);
  return pen;
}

// Number 8: tip, buttons, in range at bit 6; x and y of 24 bits; pressure of 16; two tilts.
Bytes huion_report(const PenReport& pen) {
  constexpr unsigned in_range = 1 << 6;
  Bytes r(12);
  put(r, 0, 1, 8);
  put(r, 1, 1,
      static_cast<std::int32_t>((pen.near && pen.pressure > 0 ? tip : 0) | (pen.near ? in_range : 0)));
  put(r, 2, 3, pen.x);
  put(r, 5, 3, pen.y);
  put(r, 8, 2, pen.pressure);
  put(r, 10, 1, pen.tilt_x);
  put(r, 11, 1, pen.tilt_y);
  return r;
}

std::optional<PenReport> read_huion_report(const Bytes& r) {
  if ((at(r, 1) & 1 << 6) == 0) return std::nullopt;
  PenReport pen;
  pen.x = little_endian(r, 2, 3);
  pen.y = little_endian(r, 5, 3);
  pen.pressure = little_endian(r, 8, 2);
  return pen;
}

Bytes plain_pen_descriptor() {
  return bytes({
      0x05, 0x0d, 0x09, 0x02, 0xa1, 0x01, 0x85, 0x01,  // digitizer, pen, report 1
      0x09, 0x20, 0xa1, 0x00,                          // stylus
      0x09, 0x42, 0x09, 0x32, 0x15, 0x00, 0x25, 0x01, 0x75, 0x01, 0x95, 0x02, 0x81, 0x02,  // tip, in range
      0x95, 0x06, 0x81, 0x03,                                                              // padding
      0x05, 0x01, 0x09, 0x30, 0x09, 0x31, 0x26, 0xff, 0x7f, 0x75, 0x10, 0x95, 0x02, 0x81, 0x02,  // x, y
      0x05, 0x0d, 0x09, 0x30, 0x26, 0xff, 0x0f, 0x95, 0x01, 0x81, 0x02,  // pressure to 4095
      0xc0, 0xc0,
  });
}

Bytes plain_report(const PenReport& pen) {
  Bytes r(8);
  put(r, 0, 1, 1);
  put(r, 1, 1, (pen.near && pen.pressure > 0 ? 1 : 0) | (pen.near ? 2 : 0));
  put(r, 2, 2, pen.x);
  put(r, 4, 2, pen.y);
  put(r, 6, 2, pen.pressure);
  return r;
}

std::optional<PenReport> read_plain_report(const Bytes& r) {
  if ((at(r, 1) & 2) == 0) return std::nullopt;
  PenReport pen;
  pen.x = little_endian(r, 2, 2);
  pen.y = little_endian(r, 4, 2);
  pen.pressure = little_endian(r, 6, 2);
  return pen;
}

std::vector<Bytes> strokes(Bytes (*report)(const PenReport&)) {
  constexpr int count = 10;
  constexpr int length = 60;
  std::vector<Bytes> reports;
  for (int stroke = 0; stroke < count; ++stroke) {
    for (int i = 0; i < length; ++i) {
      PenReport pen;
      pen.x = 1000 + 397 * i + 31 * stroke;
      pen.y = 2000 + 211 * i + 1009 * stroke;
      pen.pressure = i < 5 || i > 50 ? 0 : 40 * (i - 4) + stroke;
      pen.tilt_x = i - 30;
      pen.tilt_y = 30 - i / 2;
      reports.push_back(report(pen));
    }
    PenReport away;
    away.near = false;
    reports.push_back(report(away));
  }
  return reports;
}

}  // namespace fude::lab
