// Pen reports of UC-Logic's tablets and of those made after them (Huion): number 9 in eight bytes, number 8
// in twelve with tilt. They are alike for all models, so a report tells its own layout.
#pragma once

#include "drivers/tablet/hid_pen_wacom.h"

namespace fude::hid_pen {

inline constexpr std::uint16_t uclogic = 0x5543;
inline constexpr std::uint16_t huion = 0x256c;

// What the makers state of every tablet with reports of twelve bytes.
inline constexpr double uclogic_counts_per_mm = 5080 / 25.4;
inline constexpr std::int32_t uclogic_pressure = 8191;
inline constexpr std::int32_t uclogic_short_pressure = 1023;

bool is_uclogic_pen_report(Bytes report);

// `greatest_pressure` above 0.
PenReport read_uclogic(Bytes report, std::int32_t greatest_pressure, PenSample& pen);

}  // namespace fude::hid_pen
