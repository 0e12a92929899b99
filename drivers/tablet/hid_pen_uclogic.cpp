#include "drivers/tablet/hid_pen_uclogic.h"

#include <algorithm>

namespace fude::hid_pen {
namespace {

constexpr std::uint8_t short_number = 9;
constexpr std::uint8_t long_number = 8;

bool is_short(Bytes report) { return report.size() == 8 && octet(report, 0) == short_number; }

// The pad's keys and dial come under the same number, with other bits of the status set.
bool is_long(Bytes report) {
  return report.size() == 12 && octet(report, 0) == long_number && (octet(report, 1) & 0x78) == 0;
}

}  // namespace

bool is_uclogic_pen_report(Bytes report) { return is_short(report) || is_long(report); }

PenReport read_uclogic(Bytes report, std::int32_t greatest_pressure, PenSample& pen) {
  if (!is_uclogic_pen_report(report)) {
    const bool pad = report.size() == 12 && octet(report, 0) == long_number;
    return pad ? PenReport::unknown : PenReport::malformed;
  }
  const bool with_tilt = is_long(report);
  const std::uint8_t status = octet(report, 1);
  pen.in_proximity = status & (with_tilt ? 0x80 : 0x40);
  pen.tool = pen.in_proximity ? PenTool::pen : PenTool::none;
  pen.in_contact = pen.in_proximity && (status & 1);
  pen.buttons = pen.in_proximity ? status >> 1 & 3 : 0;
  pen.pressure_raw = pen.in_proximity ? little_endian<std::uint16_t>(report, 6) : 0;
  pen.pressure = Fraction(std::clamp(static_cast<double>(pen.pressure_raw) / greatest_pressure, 0.0, 1.0));
  pen.tilt_x.reset();
  pen.tilt_y.reset();
  if (!pen.in_proximity) return PenReport::sample;
  pen.x_counts = little_endian<std::uint16_t>(report, 2);
  pen.y_counts = little_endian<std::uint16_t>(report, 4);
  if (with_tilt) {
    pen.x_counts += 65536.0 * octet(report, 8);
    pen.y_counts += 65536.0 * octet(report, 9);
    const auto degrees_at = [&](std::size_t at) {
      return degrees(std::clamp<double>(static_cast<std::int8_t>(octet(report, at)), -90, 90));
    };
    pen.tilt_x = degrees_at(10);
    pen.tilt_y = -degrees_at(11);  // the tablet counts it away from the painter
  }
  return PenReport::sample;
}

}  // namespace fude::hid_pen
