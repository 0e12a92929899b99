// A painted sheet as bytes: what stands at the head of a session that began on one.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "signal/result.h"
#include "sim/ink/ink.h"

namespace fude {

struct SheetSnapshot {
  int columns = 0;  // cells
  int rows = 0;
  double cell_mm = 0;
  InkSnapshot ink;  // its steps and exchanges are those of the painting that made it, and not kept
};

SheetSnapshot sheet_of(const Ink& ink);

// docs/session-format.md has the layout.
std::vector<std::byte> as_bytes(const SheetSnapshot& sheet);

// Errors: malformed where the bytes are cut off, hold a place off the sheet or twice, or what is no amount.
Result<SheetSnapshot> sheet_from_bytes(std::span<const std::byte> bytes);

// Puts a sheet under a painting that has just begun. Errors: usage where its cells are others.
Result<void> lay_sheet(const SheetSnapshot& sheet, Ink& ink);

}  // namespace fude
