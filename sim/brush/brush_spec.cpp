#include "sim/brush/brush_spec.h"

#include <toml++/toml.h>

#include <array>
#include <cmath>
#include <fstream>
#include <iterator>

namespace fude {
namespace {

constexpr auto parameters = std::to_array<BrushParameter>({
#define BRUSH_PARAMETER(id, unit, minimum, maximum, standard, meaning) \
  {#id, unit, minimum, maximum, standard, meaning, &BrushSpec::id},
#define BRUSH_SWITCH(id, standard, meaning)
#include "sim/brush/brush_spec.inl"
#undef BRUSH_PARAMETER
#undef BRUSH_SWITCH
});

constexpr auto switches = std::to_array<BrushSwitch>({
#define BRUSH_PARAMETER(id, unit, minimum, maximum, standard, meaning)
#define BRUSH_SWITCH(id, standard, meaning) {#id, standard, meaning, &BrushSpec::id},
#include "sim/brush/brush_spec.inl"
#undef BRUSH_PARAMETER
#undef BRUSH_SWITCH
});

std::string plain(double value) {
  std::string text = std::to_string(value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

// Empty when the entry was taken; else what is wrong with it.
std::string take_entry(BrushSpec& spec, std::string_view key, const toml::node& value) {
  if (key == "name") {
    if (!value.is_string()) return "name must be a text";
    spec.name = value.value<std::string>().value();
    return {};
  }
  for (const BrushParameter& row : parameters) {
    if (row.id != key) continue;
    if (!value.is_number()) return std::string(key) + " must be a number";
    const double number = value.value<double>().value();
    const bool whole = row.unit != "count" || number == std::floor(number);
    if (!(number >= row.minimum && number <= row.maximum) || !whole)
      return std::string(key) + " must be " + (row.unit == "count" ? "a whole number " : "") + "between " +
             plain(row.minimum) + " and " + plain(row.maximum) + " (" + std::string(row.unit) + ")";
    spec.*row.member = number;
    return {};
  }
  for (const BrushSwitch& row : switches) {
    if (row.id != key) continue;
    if (!value.is_boolean()) return std::string(key) + " must be true or false";
    spec.*row.member = value.value<bool>().value();
    return {};
  }
  return "unknown parameter '" + std::string(key) + "'; docs/brush.md lists them";
}

}  // namespace

std::span<const BrushParameter> brush_parameters() { return parameters; }
std::span<const BrushSwitch> brush_switches() { return switches; }

std::vector<std::string> brush_manual_rows() {
  std::vector<std::string> rows;
  for (const BrushParameter& row : parameters)
    rows.push_back("| `" + std::string(row.id) + "` | " + std::string(row.unit) + " | " + plain(row.minimum) +
                   " to " + plain(row.maximum) + " | " + plain(row.standard) + " | " +
                   std::string(row.meaning) + " |");
  for (const BrushSwitch& row : switches)
    rows.push_back("| `" + std::string(row.id) + "` | | true, false | " + (row.standard ? "true" : "false") +
                   " | " + std::string(row.meaning) + " |");
  return rows;
}

Result<BrushSpec> parse_brush_spec(std::string_view toml, const std::string& source) {
  toml::table table;
  try {
    table = toml::parse(toml);
  } catch (const toml::parse_error& e) {
    return failure(Fault::malformed, source + ", line " + std::to_string(e.source().begin.line) + ": " +
                                         std::string(e.description()));
  }
  BrushSpec spec;
  for (const auto& [key, value] : table) {
    const std::string wrong = take_entry(spec, key.str(), value);
    if (!wrong.empty()) return failure(Fault::malformed, source + ": " + wrong);
  }
  return spec;
}

Result<BrushSpec> read_brush_spec(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  if (!file)
    return failure(Fault::not_found, "cannot read the brush " + path + "; name a file of share/brushes");
  return parse_brush_spec(text, path);
}

}  // namespace fude
