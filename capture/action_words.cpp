#include "capture/action_words.h"

#include <nlohmann/json.hpp>
#include <optional>

namespace fude {
namespace {

using nlohmann::json;

constexpr float longest_s = 60;
constexpr float deepest_mm = 1000;
constexpr float strongest = 100;

// Reads the fields of one object; remembers whether all were there and in range.
class Fields {
 public:
  explicit Fields(const json& object) : object_(object), sound_(object.is_object()) {}

  bool sound() const { return sound_; }
  bool has(const char* name) const { return sound_ && object_.contains(name); }
  float number(const char* name, float least, float most) {
    const json* value = find(name);
    return value ? number_in(*value, least, most) : 0;
  }
  Concentrations strength() {
    Concentrations strength{};
    const json* values = find("strength");
    if (!values || !values->is_array() || values->size() != strength.size()) {
      sound_ = false;
      return strength;
    }
    for (std::size_t i = 0; i < strength.size(); ++i) strength[i] = number_in((*values)[i], 0, strongest);
    return strength;
  }
  std::vector<LoadStop> ramp(const char* name) {
    std::vector<LoadStop> stops;
    const json* rows = find(name);
    if (!rows || !rows->is_array() || rows->size() > most_stops) {
      sound_ = false;
      return stops;
    }
    for (const json& row : *rows) {
      Fields fields(row);
      LoadStop stop{fields.number("along", 0, 1), fields.number("wetness", 0, 1), fields.strength()};
      sound_ = sound_ && fields.sound() && (stops.empty() || stops.back().along <= stop.along);
      stops.push_back(stop);
    }
    return stops;
  }

 private:
  const json* find(const char* name) {
    if (!has(name)) sound_ = false;
    return sound_ ? &object_[name] : nullptr;
  }
  float number_in(const json& value, float least, float most) {
    const float number = value.is_number() ? value.get<float>() : least - 1;
    if (!(number >= least && number <= most)) sound_ = false;
    return number;
  }

  const json& object_;
  bool sound_;
};

json rows_of(const std::vector<LoadStop>& stops) {
  json rows = json::array();
  for (const LoadStop& stop : stops)
    rows.push_back({{"along", stop.along}, {"wetness", stop.wetness}, {"strength", stop.strength}});
  return rows;
}

struct CareWords {
  ActionWords operator()(const LoadBrush& load) const {
    return {"load", json{{"wetness", load.wetness}, {"strength", load.strength}}.dump()};
  }
  ActionWords operator()(const GradeBrush& ramps) const {
    return {"grade", json{{"side", rows_of(ramps.side)}, {"far_side", rows_of(ramps.far_side)}}.dump()};
  }
  ActionWords operator()(const DipBrush& dip) const {
    return {"dip",
            json{{"depth_mm", dip.depth_mm}, {"seconds", dip.seconds}, {"strength", dip.strength}}.dump()};
  }
  ActionWords operator()(const RinseBrush& rinse) const {
    return {"rinse", json{{"seconds", rinse.seconds}}.dump()};
  }
  ActionWords operator()(const WipeBrush& wipe) const {
    return {"wipe", json{{"fullest", wipe.fullest}}.dump()};
  }
  ActionWords operator()(const BlotBrush& blot) const {
    json arguments{{"seconds", blot.seconds}};
    if (blot.side) arguments["side"] = *blot.side;
    return {"blot", arguments.dump()};
  }
  ActionWords operator()(const RollBrush& roll) const { return {"roll", json{{"turns", roll.turns}}.dump()}; }
};

std::optional<BrushCare> care_from(const std::string& verb, Fields& fields) {
  if (verb == "load") return LoadBrush{fields.number("wetness", 0, 1), fields.strength()};
  if (verb == "grade") {
    GradeBrush ramps{fields.ramp("side"), fields.ramp("far_side")};
    if (ramps.side.empty()) return std::nullopt;
    return ramps;
  }
  if (verb == "dip")
    return DipBrush{fields.number("depth_mm", 0, deepest_mm), fields.number("seconds", 0, longest_s),
                    fields.strength()};
  if (verb == "rinse") return RinseBrush{fields.number("seconds", 0, longest_s)};
  if (verb == "wipe") return WipeBrush{fields.number("fullest", 0, 1)};
  if (verb == "roll") return RollBrush{fields.number("turns", 0, 1000)};
  if (verb != "blot") return std::nullopt;
  BlotBrush blot{fields.number("seconds", 0, longest_s), std::nullopt};
  if (fields.has("side")) blot.side = fields.number("side", -1, 1);
  return blot;
}

}  // namespace

ActionWords words_for(const Action& action) {
  struct Visitor {
    ActionWords operator()(const BrushCare& care) const { return std::visit(CareWords{}, care); }
    ActionWords operator()(const ReshapeBrush&) const { return {"reshape", "{}"}; }
    ActionWords operator()(const DrySheet&) const { return {"dry", "{}"}; }
    ActionWords operator()(const Undo&) const { return {"undo", "{}"}; }
    ActionWords operator()(const Redo&) const { return {"redo", "{}"}; }
  };
  return std::visit(Visitor{}, action.what);
}

Result<Action> action_from(Timestamp time, const std::string& verb, const std::string& arguments) {
  if (verb == "reshape") return Action{time, ReshapeBrush{}};
  if (verb == "dry") return Action{time, DrySheet{}};
  if (verb == "undo") return Action{time, Undo{}};
  if (verb == "redo") return Action{time, Redo{}};
  const json parsed = json::parse(arguments, nullptr, false);
  Fields fields(parsed);
  if (auto care = care_from(verb, fields); care && fields.sound()) return Action{time, std::move(*care)};
  return failure(Fault::malformed, "the session holds an action '" + verb + "' that cannot be read");
}

}  // namespace fude
