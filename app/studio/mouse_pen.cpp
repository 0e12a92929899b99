#include "app/studio/mouse_pen.h"

#include <linux/input-event-codes.h>

#include <cmath>

namespace fude {
namespace {

constexpr double counts_per_mm = 100;

AxisRange axis(std::uint16_t code, Millimetres length) {
  return {.code = code,
          .maximum = static_cast<std::int32_t>(std::lround(length.value * counts_per_mm)),
          .resolution = static_cast<std::int32_t>(counts_per_mm)};
}

}  // namespace

DeviceDescription mouse_description(Extent sheet) {
  DeviceDescription mouse;
  mouse.id = "mouse";
  mouse.name = "mouse as a pen";
  mouse.kind = DeviceKind::mouse;
  mouse.transport = "mouse";
  mouse.axes = {axis(ABS_X, sheet.width), axis(ABS_Y, sheet.height)};
  mouse.width = sheet.width;
  mouse.height = sheet.height;
  return mouse;
}

PenSample MousePen::sample(Timestamp now) {
  PenSample pen;
  pen.time.host = now;
  pen.time.stamped_by = StampedBy::arrival;
  pen.time.sequence = ++sequence;
  pen.tool = over_paper ? PenTool::pen : PenTool::none;
  pen.in_proximity = over_paper;
  pen.in_contact = over_paper && pressed;
  pen.x_counts = std::round(at_mm.x() * counts_per_mm);
  pen.y_counts = std::round((sheet.height.value - at_mm.y()) * counts_per_mm);
  pen.pressure = Fraction(pen.in_contact ? pressure : 0);
  return pen;
}

}  // namespace fude
