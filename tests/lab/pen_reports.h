// Reports of a few tablets, written and read by their layout alone; bits as their descriptors or, for
// Wacom's opaque ones, as linux/drivers/hid/wacom_wac.c names them.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "tests/lab/uhid_device.h"

namespace fude::lab {

struct PenReport {
  std::int32_t x = 0;
  std::int32_t y = 0;
  std::int32_t pressure = 0;
  std::int32_t tilt_x = 0;  // degrees
  std::int32_t tilt_y = 0;
  bool near = true;
};

// Wacom's protocol of Intuos 1 to Intuos Pro: none where a report does not say where the pen is.
std::optional<PenReport> intuos_report(const Bytes& report);

Bytes cintiq_pro_report(const PenReport& pen);
std::optional<PenReport> read_cintiq_pro_report(const Bytes& report);

Bytes huion_report(const PenReport& pen);
std::optional<PenReport> read_huion_report(const Bytes& report);

// A digitizer pen with tip, in range, 16-bit X, Y and pressure; report number 1.
Bytes plain_pen_descriptor();
Bytes plain_report(const PenReport& pen);
std::optional<PenReport> read_plain_report(const Bytes& report);

// Ten strokes of sixty reports, the pen leaving after each.
std::vector<Bytes> strokes(Bytes (*report)(const PenReport&));

}  // namespace fude::lab
