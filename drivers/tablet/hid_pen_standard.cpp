#include "drivers/tablet/hid_pen_standard.h"

#include <algorithm>
#include <numbers>
#include <span>

namespace fude::hid_pen {
namespace {

constexpr std::uint16_t generic = 0x01;
constexpr std::uint16_t digitizer = 0x0d;
constexpr hid::Usage applications[] = {hid::usage(digitizer, 0x01),
                                       hid::usage(digitizer, 0x02)};  // digitizer, pen

double counts(const hid::Field& field) {
  return static_cast<double>(field.logical_maximum) - static_cast<double>(field.logical_minimum);
}

Fraction share(const hid::Field& field, std::int32_t raw) {
  return Fraction(std::clamp((static_cast<double>(raw) - field.logical_minimum) / counts(field), 0.0, 1.0));
}

// By the unit where one is stated; plain numbers of up to 90 are degrees, wider ones as the kernel takes
// them: the full range for 64 degrees to either side.
Radians angle(const hid::Field& field, std::int32_t raw) {
  const bool physical = field.physical_maximum != field.physical_minimum;
  if (physical && (field.unit == 0x14 || field.unit == 0x12)) {
    const double low = field.physical_minimum, high = field.physical_maximum;
    double value = low + (high - low) * (static_cast<double>(raw) - field.logical_minimum) / counts(field);
    for (int i = 0; i < field.unit_exponent; ++i) value *= 10;
    for (int i = 0; i > field.unit_exponent; --i) value /= 10;
    return field.unit == 0x14 ? degrees(value) : Radians(value);
  }
  const double middle = 0.5 * (static_cast<double>(field.logical_minimum) + field.logical_maximum);
  const double off = static_cast<double>(raw) - middle;
  return degrees(counts(field) <= 180 ? off : 128 * off / counts(field));
}

Radians lean(const hid::Field& field, std::int32_t raw) {
  return std::clamp(angle(field, raw), degrees(-90), degrees(90));
}

// The barrel's turn: the whole range is once around.
Radians turn(const hid::Field& field, std::int32_t raw) {
  return Radians(2 * std::numbers::pi * (share(field, raw).value - 0.5));
}

bool is_of_a_pen(const hid::Field& field) {
  return !field.relative && counts(field) > 0 && std::ranges::count(applications, field.application) != 0;
}

// Of the values of one report.
std::optional<StandardPen> standard_pen(std::span<const hid::Field> values) {
  std::size_t bytes = 0;
  const auto find = [&](std::uint16_t page, std::uint16_t id) -> std::optional<hid::Field> {
    const auto found = std::ranges::find(values, hid::usage(page, id), &hid::Field::usage);
    if (found == values.end()) return std::nullopt;
    bytes = std::max(bytes, hid::bytes_through(*found));
    return *found;
  };
  const auto x = find(generic, 0x30), y = find(generic, 0x31);
  const auto tip = find(digitizer, 0x42), pressure = find(digitizer, 0x30);
  if (!x || !y || (!tip && !pressure)) return std::nullopt;
  StandardPen pen{.x = *x,
                  .y = *y,
                  .tip = tip,
                  .in_range = find(digitizer, 0x32),
                  .eraser = find(digitizer, 0x45),
                  .invert = find(digitizer, 0x3c),
                  .barrel = find(digitizer, 0x44),
                  .second_barrel = find(digitizer, 0x5a),
                  .pressure = pressure,
                  .tilt_x = find(digitizer, 0x3d),
                  .tilt_y = find(digitizer, 0x3e),
                  .twist = find(digitizer, 0x41),
                  .serial = find(digitizer, 0x5b)};
  pen.bytes = bytes;
  return pen;
}

}  // namespace

std::vector<StandardPen> standard_pens(Bytes descriptor) {
  auto parsed = hid::parse_descriptor(descriptor);
  std::vector<StandardPen> pens;
  if (!parsed) return pens;
  auto& values = parsed->inputs;
  std::erase_if(values, [](const hid::Field& field) { return !is_of_a_pen(field); });
  std::ranges::stable_sort(values, {}, &hid::Field::report);
  for (auto first = values.begin(); first != values.end();) {
    const auto end = std::ranges::upper_bound(first, values.end(), first->report, {}, &hid::Field::report);
    if (const auto pen = standard_pen({first, end})) pens.push_back(*pen);
    first = end;
  }
  return pens;
}

PenReport read_standard(const StandardPen& layout, Bytes report, PenSample& pen) {
  if (layout.x.report != 0 && !report.empty() && octet(report, 0) != layout.x.report)
    return PenReport::unknown;
  if (report.size() < layout.bytes) return PenReport::malformed;
  const auto number = [&](const std::optional<hid::Field>& field) {
    return field ? hid::value(*field, report) : std::nullopt;
  };
  const auto on = [&](const std::optional<hid::Field>& field) { return number(field).value_or(0) != 0; };
  const auto pressure = number(layout.pressure);
  const bool erases = on(layout.eraser);
  const bool touches =
      layout.tip ? on(layout.tip) || erases : pressure && *pressure > layout.pressure->logical_minimum;
  pen.in_proximity = layout.in_range ? on(layout.in_range) || touches : true;
  pen.in_contact = touches;
  pen.tool = !pen.in_proximity ? PenTool::none : erases || on(layout.invert) ? PenTool::rubber : PenTool::pen;
  pen.buttons = (on(layout.barrel) ? 1U : 0U) | (on(layout.second_barrel) ? 2U : 0U);
  pen.tool_serial = static_cast<std::uint32_t>(number(layout.serial).value_or(0));
  pen.pressure_raw = pressure.value_or(0);
  pen.pressure = pressure ? share(*layout.pressure, *pressure) : Fraction(touches ? 1 : 0);
  pen.tilt_x.reset();
  pen.tilt_y.reset();
  pen.rotation.reset();
  if (const auto raw = number(layout.tilt_x)) pen.tilt_x = lean(*layout.tilt_x, *raw);
  if (const auto raw = number(layout.tilt_y)) pen.tilt_y = lean(*layout.tilt_y, *raw);
  if (const auto raw = number(layout.twist)) pen.rotation = turn(*layout.twist, *raw);
  pen.x_counts = hid::value(layout.x, report).value_or(0);
  pen.y_counts = hid::value(layout.y, report).value_or(0);
  return PenReport::sample;
}

}  // namespace fude::hid_pen
