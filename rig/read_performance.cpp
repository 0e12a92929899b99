#include <toml++/toml.h>

#include <cmath>
#include <utility>

#include "rig/performance.h"
#include "rig/read_care.h"

namespace fude {
namespace {

constexpr double longest_beat_s = 60;

std::optional<double> number(const toml::node* node) {
  if (!node) return std::nullopt;
  const auto value = node->value<double>();
  return value && std::isfinite(*value) ? value : std::nullopt;
}

std::optional<PerformedKnot> knot_from(const toml::node& node) {
  const toml::array* row = node.as_array();
  if (!row || row->size() < 3 || row->size() > 4) return std::nullopt;
  const auto x = number(row->get(0));
  const auto y = number(row->get(1));
  const auto pressure = number(row->get(2));
  const auto beat = number(row->get(3));
  if (!x || !y || !pressure || *pressure < 0 || *pressure > 1) return std::nullopt;
  if (row->size() == 4 && !(beat && *beat > 0 && *beat <= longest_beat_s)) return std::nullopt;
  return PerformedKnot{*x, *y, *pressure, beat};
}

std::optional<PerformedStroke> stroke_from(const toml::table& table, const PaintBox& box) {
  PerformedStroke stroke;
  stroke.name = table["name"].value_or("");
  stroke.tilt_x = degrees(table["tilt_x_deg"].value_or(0.0));
  stroke.tilt_y = degrees(table["tilt_y_deg"].value_or(0.0));
  stroke.rest_s = table["rest_s"].value_or(stroke.rest_s);
  if (const toml::array* rows = table["prepare"].as_array()) {
    auto cares = cares_from(*rows, box);
    if (!cares) return std::nullopt;
    stroke.prepare = std::move(*cares);
  } else if (table.contains("prepare")) {
    return std::nullopt;
  }
  if (const toml::table* row = table["load"].as_table()) {
    const auto load = load_from(*row, box);
    if (!load) return std::nullopt;
    stroke.prepare.emplace_back(*load);
  }
  const toml::array* knots = table["knots"].as_array();
  if (!knots || !(stroke.rest_s > 0 && stroke.rest_s <= longest_beat_s)) return std::nullopt;
  for (const toml::node& node : *knots) {
    const auto knot = knot_from(node);
    if (!knot) return std::nullopt;
    stroke.knots.push_back(*knot);
  }
  if (stroke.knots.size() < 2 || !stroke.knots.back().beat_s) return std::nullopt;
  return stroke;
}

}  // namespace

Result<Performance> read_performance(std::string_view text, const std::string& source) {
  toml::table table;
  try {
    table = toml::parse(text, source);
  } catch (const toml::parse_error& e) {
    return failure(Fault::malformed, source + ": line " + std::to_string(e.source().begin.line) + ": " +
                                         std::string(e.description()));
  }
  Performance performance;
  performance.name = table["name"].value_or("");
  performance.rate_hz = table["rate_hz"].value_or(performance.rate_hz);
  performance.width = Millimetres(table["width_mm"].value_or(0.0));
  performance.height = Millimetres(table["height_mm"].value_or(0.0));
  if (performance.name.empty() || !(performance.rate_hz >= 10 && performance.rate_hz <= 2000) ||
      !(performance.width.value >= 1 && performance.width.value <= 2000) ||
      !(performance.height.value >= 1 && performance.height.value <= 2000))
    return failure(
        Fault::malformed,
        source + ": a performance has a name, rate_hz (10 to 2000), width_mm and height_mm (1 to 2000)");
  if (table.contains("sheet_mm")) {
    const auto width = table["sheet_mm"][0].value<double>();
    const auto height = table["sheet_mm"][1].value<double>();
    if (!width || !height || !(*width >= 1 && *width <= performance.width.value) ||
        !(*height >= 1 && *height <= performance.height.value))
      return failure(Fault::malformed, source + ": sheet_mm = [width, height] is no larger than the tablet");
    performance.sheet = Extent{Millimetres(*width), Millimetres(*height)};
  }
  PaintBox box{.name = "ink", .pigments = {pigments()[0]}, .spots = {}, .toml = {}};
  if (const auto name = table["palette"].value<std::string>()) {
    auto palette = find_paint_box(*name);
    if (!palette) return tl::unexpected(palette.error());
    box = *palette;
    performance.palette = std::move(*palette);
  }
  if (const toml::array* strokes = table["stroke"].as_array())
    for (const toml::node& node : *strokes) {
      const auto stroke = node.as_table() ? stroke_from(*node.as_table(), box) : std::nullopt;
      if (!stroke)
        return failure(Fault::malformed,
                       source + ": line " + std::to_string(node.source().begin.line) +
                           ": a stroke has knots [x, y, pressure] or [x, y, pressure, seconds], two "
                           "at least, the last with seconds; what loads it and prepares it, and colours of "
                           "its palette, as docs/performances.md tells");
      performance.strokes.push_back(*stroke);
    }
  if (performance.strokes.empty()) return failure(Fault::malformed, source + ": no [[stroke]]");
  return performance;
}

}  // namespace fude
