#include "drivers/tablet/hid_pen_wacom.h"

#include <algorithm>
#include <array>
#include <numbers>

namespace fude::hid_pen {
namespace {

constexpr std::uint8_t pen_report = 2;
constexpr std::int32_t touches_above = 10;  // of 2047; the kernel's threshold

constexpr WacomModel models[] = {
#define WACOM_HID_PEN(product, name, layout, across, down, pressure, counts_per_mm) \
  {product, name, WacomLayout::layout, across, down, pressure, counts_per_mm},
#include "drivers/tablet/hid_pen_models.inl"
#undef WACOM_HID_PEN
};

// None for mice and lenses. A pen's other end is its own type, an unknown type a pen.
std::optional<PenTool> tool_of(std::uint32_t type) {
  constexpr auto one_of = [](std::uint32_t t, const auto& list) {
    return std::find(list.begin(), list.end(), t) != list.end();
  };
  constexpr std::array<std::uint32_t, 8> no_pens{0x007, 0x09c, 0x094, 0x017, 0x806, 0x096, 0x097, 0x006};
  constexpr std::array<std::uint32_t, 4> pencils{0x812, 0x801, 0x120802, 0x012};
  constexpr std::array<std::uint32_t, 2> brushes{0x832, 0x032};
  constexpr std::array<std::uint32_t, 6> airbrushes{0xd12, 0x912, 0x112, 0x913, 0x902, 0x100902};
  constexpr std::array<std::uint32_t, 17> rubbers{0x82a,    0x85a,    0x91a,    0xd1a,    0x0fa,   0x82b,
                                                  0x81b,    0x91b,    0x80c,    0x80a,    0x90a,   0x14080a,
                                                  0x10090a, 0x10080c, 0x16080a, 0x18080a, 0x10080a};
  if (one_of(type, no_pens)) return std::nullopt;
  if (one_of(type, pencils)) return PenTool::pencil;
  if (one_of(type, brushes)) return PenTool::brush;
  if (one_of(type, airbrushes)) return PenTool::airbrush;
  if (one_of(type, rubbers)) return PenTool::rubber;
  return PenTool::pen;
}

void set_pressure(const WacomModel& model, std::int32_t raw, PenSample& pen) {
  pen.pressure_raw = raw;
  pen.pressure = Fraction(std::clamp(static_cast<double>(raw) / model.pressure, 0.0, 1.0));
}

// Where it was stays; the rest says nothing any more.
void leave(PenSample& pen) {
  PenSample gone;
  gone.time = pen.time;
  gone.x_counts = pen.x_counts;
  gone.y_counts = pen.y_counts;
  gone.tool_serial = pen.tool_serial;
  gone.tool_id = pen.tool_id;
  pen = gone;
}

PenReport read_graphire(const WacomModel& model, Bytes report, PenSample& pen) {
  const std::uint8_t status = octet(report, 1);
  if (!(status & 0x80)) {
    if (pen.tool == PenTool::none) return PenReport::unknown;
    leave(pen);
    return PenReport::sample;
  }
  const int tool = status >> 5 & 3;
  if (tool >= 2) return PenReport::unknown;  // its mouse
  pen.tool = tool == 1 ? PenTool::rubber : PenTool::pen;
  pen.in_proximity = true;
  pen.x_counts = little_endian<std::uint16_t>(report, 2);
  pen.y_counts = little_endian<std::uint16_t>(report, 4);
  set_pressure(model, octet(report, 6) | (octet(report, 7) & 3) << 8, pen);
  pen.in_contact = status & 1;
  pen.buttons = status >> 1 & 3;
  return PenReport::sample;
}

PenReport enter(Bytes report, PenSample& pen) {
  pen.tool_serial = std::uint64_t{octet(report, 3) & 0x0fU} << 28 | std::uint64_t{octet(report, 4)} << 20 |
                    std::uint64_t{octet(report, 5)} << 12 | std::uint64_t{octet(report, 6)} << 4 |
                    octet(report, 7) >> 4;
  pen.tool_id = std::uint32_t{octet(report, 2)} << 4 | octet(report, 3) >> 4 |
                (octet(report, 7) & 0x0fU) << 20 | (octet(report, 8) & 0xf0U) << 12;
  const auto tool = tool_of(pen.tool_id);
  pen.tool = tool.value_or(PenTool::none);
  return tool ? PenReport::entered : PenReport::unknown;
}

PenReport read_intuos(const WacomModel& model, Bytes report, PenSample& pen) {
  const std::uint8_t status = octet(report, 1);
  if ((status & 0xfc) == 0xc0) return enter(report, pen);
  if ((status & 0xfe) == 0x80) {
    const bool was_pen = pen.tool != PenTool::none;
    leave(pen);
    pen.tool_serial = 0;
    pen.tool_id = 0;
    return was_pen ? PenReport::sample : PenReport::unknown;
  }
  if (pen.tool_id != 0 && !tool_of(pen.tool_id)) return PenReport::unknown;
  if ((status & 0xfe) == 0x20) {  // still felt, too far for a position
    if (!pen.in_proximity) return PenReport::unknown;
    pen.in_contact = false;
    pen.distance = Fraction(1);
    set_pressure(model, 0, pen);
    return PenReport::sample;
  }
  if (pen.tool == PenTool::none) pen.tool = PenTool::pen;  // the recording began with it on the tablet
  const auto tilt = [&] {
    pen.tilt_x = degrees(static_cast<double>((octet(report, 7) << 1 & 0x7e) | octet(report, 8) >> 7) - 64);
    pen.tilt_y = degrees(static_cast<double>(octet(report, 8) & 0x7f) - 64);
  };
  switch (status >> 1 & 15) {
    case 0:
    case 1:
    case 2:
    case 3: {
      std::int32_t raw = octet(report, 6) << 3 | (octet(report, 7) & 0xc0) >> 5 | (status & 1);
      if (model.pressure < 2047) raw >>= 1;
      set_pressure(model, raw, pen);
      pen.in_contact = raw > touches_above;
      pen.buttons = status >> 1 & 3;
      tilt();
      break;
    }
    case 5: {  // barrel rotation; the kernel's count of 1800 to the turn, 0 in the middle
      const int raw = octet(report, 6) << 3 | octet(report, 7) >> 5;
      const int half =
          octet(report, 7) & 0x20 ? (raw > 900 ? (raw - 1) / 2 - 1350 : (raw - 1) / 2 + 450) : 450 - raw / 2;
      pen.rotation = Radians(half * (std::numbers::pi / 900));
      break;
    }
    case 10:  // the airbrush's wheel
      pen.wheel = Fraction((octet(report, 6) << 2 | octet(report, 7) >> 6) / 1023.0);
      tilt();
      break;
    default:
      return PenReport::unknown;
  }
  pen.in_proximity = true;
  pen.x_counts = big_endian<std::uint16_t>(report, 2) * 2 + (octet(report, 9) >> 1 & 1);
  pen.y_counts = big_endian<std::uint16_t>(report, 4) * 2 + (octet(report, 9) & 1);
  pen.distance = Fraction((octet(report, 9) >> 2) / 63.0);
  return PenReport::sample;
}

}  // namespace

std::optional<WacomModel> wacom_model(std::uint16_t product) {
  for (const WacomModel& model : models)
    if (model.product == product) return model;
  return std::nullopt;
}

PenReport read_wacom(const WacomModel& model, Bytes report, PenSample& pen) {
  if (report.empty()) return PenReport::malformed;
  if (octet(report, 0) != pen_report) return PenReport::unknown;
  const bool graphire = model.layout == WacomLayout::graphire;
  if (report.size() != (graphire ? 8U : 10U)) return PenReport::malformed;
  return graphire ? read_graphire(model, report, pen) : read_intuos(model, report, pen);
}

}  // namespace fude::hid_pen
