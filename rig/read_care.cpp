#include "rig/read_care.h"

#include <cmath>

namespace fude {
namespace {

constexpr float strongest = 100;
constexpr float standard_glue = 0.1F;

std::optional<float> number(const toml::table& table, std::string_view key, float least, float most,
                            std::optional<float> standard = {}) {
  const toml::node* node = table.get(key);
  if (!node) return standard;
  const auto value = node->value<double>();
  if (!value || !(*value >= static_cast<double>(least) && *value <= static_cast<double>(most)))
    return std::nullopt;
  return static_cast<float>(*value);
}

// Pigments by their names, `ink` the first of them: all of it where no pigment is named.
std::optional<Concentrations> strength_from(const toml::table& table, const PaintBox& box) {
  Concentrations strength{};
  bool named = table.contains("ink");
  for (std::size_t i = 0; i < box.pigments.size(); ++i) {
    const auto value = number(table, box.pigments[i].name, 0, strongest, 0.0F);
    if (!value) return std::nullopt;
    strength[i] = *value;
    named = named || table.contains(box.pigments[i].name);
  }
  const auto ink = number(table, "ink", 0, strongest, named ? strength[0] : 1.0F);
  const auto glue = number(table, "glue", 0, strongest, standard_glue);
  if (!ink || !glue) return std::nullopt;
  strength[0] = *ink;
  strength[glue_channel] = *glue;
  return strength;
}

// Every key is one of these or the name of a pigment: a misspelt colour is not clear water.
bool knows_all(const toml::table& table, const PaintBox& box, std::initializer_list<std::string_view> keys) {
  for (const auto& [key, value] : table) {
    const auto is = [&](std::string_view known) { return key.str() == known; };
    bool known = is("ink") || is("glue");
    for (const std::string_view other : keys) known = known || is(other);
    for (const Pigment& pigment : box.pigments) known = known || is(pigment.name);
    if (!known) return false;
  }
  return true;
}

std::optional<std::vector<LoadStop>> ramp_from(const toml::array* rows, const PaintBox& box) {
  std::vector<LoadStop> stops;
  if (!rows || rows->empty() || rows->size() > most_stops) return std::nullopt;
  for (const toml::node& node : *rows) {
    const toml::table* row = node.as_table();
    if (!row || !knows_all(*row, box, {"at", "wetness"})) return std::nullopt;
    const auto at = number(*row, "at", 0, 1);
    const auto wetness = number(*row, "wetness", 0, 1, 1.0F);
    const auto strength = strength_from(*row, box);
    if (!at || !wetness || !strength || (!stops.empty() && stops.back().along > *at)) return std::nullopt;
    stops.push_back({*at, *wetness, *strength});
  }
  return stops;
}

std::optional<BrushCare> dip_from(const toml::table& row, const PaintBox& box) {
  const auto depth = number(row, "depth_mm", 0, 1000);
  const auto seconds = number(row, "seconds", 0, 60, 0.5F);
  const toml::table* ink = row["dip"].as_table();
  if (!depth || !seconds || !ink || !knows_all(*ink, box, {})) return std::nullopt;
  const auto strength = strength_from(*ink, box);
  if (!strength) return std::nullopt;
  return DipBrush{*depth, *seconds, *strength};
}

std::optional<BrushCare> blot_from(const toml::table& row) {
  const auto seconds = number(row, "blot", 0, 60);
  if (!seconds) return std::nullopt;
  BlotBrush blot{*seconds, std::nullopt};
  if (row.contains("side") && !(blot.side = number(row, "side", -1, 1))) return std::nullopt;
  return blot;
}

std::optional<decltype(Action::what)> care_from(const toml::table& row, const PaintBox& box) {
  if (row.contains("dip")) return dip_from(row, box);
  if (row.contains("blot")) return blot_from(row);
  if (const toml::table* load = row["load"].as_table()) return load_from(*load, box);
  if (row["reshape"].value_or(false)) return ReshapeBrush{};
  if (const auto seconds = number(row, "rinse", 0, 60)) return BrushCare(RinseBrush{*seconds});
  if (const auto fullest = number(row, "wipe", 0, 1)) return BrushCare(WipeBrush{*fullest});
  if (const auto turns = number(row, "roll", 0, 1000)) return BrushCare(RollBrush{*turns});
  return std::nullopt;
}

}  // namespace

std::optional<Concentrations> ink_from(const toml::table& table, const PaintBox& box) {
  return knows_all(table, box, {}) ? strength_from(table, box) : std::nullopt;
}

std::optional<BrushCare> load_from(const toml::table& table, const PaintBox& box) {
  if (table.contains("stops")) {
    auto side = ramp_from(table["stops"].as_array(), box);
    std::optional<std::vector<LoadStop>> far_side{std::in_place};
    if (table.contains("far_stops")) far_side = ramp_from(table["far_stops"].as_array(), box);
    if (!side || !far_side) return std::nullopt;
    return GradeBrush{std::move(*side), std::move(*far_side)};
  }
  const auto wetness = number(table, "wetness", 0, 1, 1.0F);
  const auto strength = strength_from(table, box);
  if (!wetness || !strength || !knows_all(table, box, {"wetness"})) return std::nullopt;
  return LoadBrush{*wetness, *strength};
}

std::optional<std::vector<decltype(Action::what)>> cares_from(const toml::array& rows, const PaintBox& box) {
  std::vector<decltype(Action::what)> cares;
  for (const toml::node& node : rows) {
    const auto care = node.as_table() ? care_from(*node.as_table(), box) : std::nullopt;
    if (!care) return std::nullopt;
    cares.push_back(*care);
  }
  return cares;
}

}  // namespace fude
