#include "rig/paint_box.h"

#include <toml++/toml.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <optional>
#include <utility>

#include "rig/read_care.h"
#include "rig/share_folder.h"

namespace fude {
namespace {

Error wrong(const std::string& source, const std::string& what) {
  return {Fault::malformed, source + ": " + what};
}

std::optional<double> number(const toml::table& row, std::string_view key, double least, double most) {
  const auto value = row[key].value<double>();
  return value && *value >= least && *value <= most ? value : std::nullopt;
}

std::optional<PlacedSpot> spot_from(const toml::table& row, std::string_view kind, const PaintBox& box) {
  constexpr double farthest_mm = 10'000;
  PlacedSpot spot;
  spot.name = row["name"].value_or(std::string(kind));
  const auto x = row["at_mm"][0].value<double>();
  const auto y = row["at_mm"][1].value<double>();
  const auto radius = number(row, "radius_mm", 0.5, farthest_mm);
  if (!x || !y || !radius || !(std::abs(*x) <= farthest_mm && std::abs(*y) <= farthest_mm))
    return std::nullopt;
  spot.x_mm = *x;
  spot.y_mm = *y;
  spot.radius_mm = *radius;
  if (kind == "cloth") {
    spot.spot = Cloth{};
  } else if (kind == "rim") {
    const auto fullest = number(row, "fullest", 0, 1);
    if (!fullest) return std::nullopt;
    spot.spot = Rim{*fullest};
  } else {
    const auto depth = number(row, "depth_mm", 0.1, 1000);
    const toml::table* ink = row["ink"].as_table();
    const auto strength = ink ? ink_from(*ink, box) : std::optional(Concentrations{});
    if (!depth || !strength) return std::nullopt;
    spot.spot = Bath{*strength, *depth};
  }
  return spot;
}

}  // namespace

const PlacedSpot* spot_at(const std::vector<PlacedSpot>& spots, double x_mm, double y_mm) {
  for (const PlacedSpot& spot : spots) {
    const double dx = x_mm - spot.x_mm;
    const double dy = y_mm - spot.y_mm;
    if (dx * dx + dy * dy <= spot.radius_mm * spot.radius_mm) return &spot;
  }
  return nullptr;
}

Result<PaintBox> read_paint_box(std::string_view text, const std::string& source) {
  toml::table table;
  try {
    table = toml::parse(text, source);
  } catch (const toml::parse_error& e) {
    return tl::unexpected(
        wrong(source, "line " + std::to_string(e.source().begin.line) + ": " + std::string(e.description())));
  }
  PaintBox box;
  box.toml = text;
  box.name = table["name"].value_or("");
  const toml::array* names = table["pigments"].as_array();
  if (!names || names->empty() || names->size() > glue_channel)
    return tl::unexpected(wrong(source, "a palette has pigments, one to three names"));
  for (const toml::node& node : *names) {
    auto pigment = find_pigment(node.value_or(std::string_view{}));
    if (!pigment) return tl::unexpected(pigment.error());
    box.pigments.push_back(*pigment);
  }
  for (const std::string_view kind : {"well", "cloth", "rim"}) {
    const toml::array* rows = table[kind].as_array();
    if (!rows) continue;
    for (const toml::node& node : *rows) {
      auto spot = node.as_table() ? spot_from(*node.as_table(), kind, box) : std::nullopt;
      if (!spot)
        return tl::unexpected(
            wrong(source, "line " + std::to_string(node.source().begin.line) +
                              ": a spot has at_mm = [x, y] and radius_mm; a [[well]] depth_mm and its ink by "
                              "the palette's pigments, a [[rim]] fullest (0 to 1)"));
      box.spots.push_back(std::move(*spot));
    }
  }
  return box;
}

Result<PaintBox> find_paint_box(const std::string& name) {
  const auto file = find_shared("palettes", name, ".toml");
  if (!file) return tl::unexpected(file.error());
  std::ifstream in(*file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  if (!in) return failure(Fault::not_found, "cannot read the palette " + file->string());
  return read_paint_box(text, file->string());
}

}  // namespace fude
