// What a brush is made of: every value of brush_spec.inl, read from TOML (share/brushes).
// Lengths in millimetres, forces in millinewtons, times in seconds, angles in radians.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "signal/result.h"

namespace fude {

struct BrushSpec {
  std::string name = "round-goat";
#define BRUSH_PARAMETER(id, unit, minimum, maximum, standard, meaning) double id = standard;
#define BRUSH_SWITCH(id, standard, meaning) bool id = standard;
#include "sim/brush/brush_spec.inl"
#undef BRUSH_PARAMETER
#undef BRUSH_SWITCH
  bool operator==(const BrushSpec&) const = default;
};

// One row of the table, for panels and the manual.
struct BrushParameter {
  std::string_view id;
  std::string_view unit;
  double minimum;
  double maximum;
  double standard;
  std::string_view meaning;
  double BrushSpec::*member;
};
std::span<const BrushParameter> brush_parameters();

struct BrushSwitch {
  std::string_view id;
  bool standard;
  std::string_view meaning;
  bool BrushSpec::*member;
};
std::span<const BrushSwitch> brush_switches();

// The rows of the table in docs/brush.md, one a parameter or switch.
std::vector<std::string> brush_manual_rows();

// Reads `name`, any parameter and any switch; what is absent keeps its standard value. Fails
// (malformed) on bad TOML, an unknown key, a wrong type, or a value out of its range; the message
// names `source`.
Result<BrushSpec> parse_brush_spec(std::string_view toml, const std::string& source);

// The same from a file; not_found when it cannot be read.
Result<BrushSpec> read_brush_spec(const std::string& path);

}  // namespace fude
