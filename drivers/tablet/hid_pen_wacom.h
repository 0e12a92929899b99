// Wacom's pen reports, number 2, whose layout no descriptor states: eight bytes of the Graphires, ten of the
// Intuos and Cintiqs. firmware-notes/hid-pens.md draws them.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "drivers/byte_order.h"
#include "signal/pen_sample.h"

namespace fude::hid_pen {

inline constexpr std::uint16_t wacom = 0x056a;

enum class WacomLayout : std::uint8_t { graphire, intuos };

struct WacomModel {
  std::uint16_t product;
  std::string_view name;
  WacomLayout layout;
  std::int32_t across, down;  // counts
  std::int32_t pressure;      // greatest
  double counts_per_mm;
};

// Of hid_pen_models.inl; none for others.
std::optional<WacomModel> wacom_model(std::uint16_t product);

// What a report was.
enum class PenReport : std::uint8_t {
  sample,     // the state has changed
  entered,    // a tool came near and told what it is; no position yet
  malformed,  // of another length
  unknown,    // of another number, or of a tool that is no pen
};

// Brings `pen` up to date; its time is left alone. Bytes of any content are safe.
PenReport read_wacom(const WacomModel& model, Bytes report, PenSample& pen);

}  // namespace fude::hid_pen
