#include "app/studio/script.h"

#include <cmath>
#include <map>
#include <optional>
#include <sstream>

namespace fude {
namespace {

std::optional<double> number(std::istringstream& words) {
  double value = 0;
  if (!(words >> value) || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<StudioEvent> event_of(const std::string& verb, std::istringstream& words) {
  static const std::map<std::string, StudioKey> keys = {
      {"undo", StudioKey::undo},       {"redo", StudioKey::redo},   {"load", StudioKey::load},
      {"dip", StudioKey::dip},         {"rinse", StudioKey::rinse}, {"wipe", StudioKey::wipe},
      {"blot", StudioKey::blot},       {"roll", StudioKey::roll},   {"gradient", StudioKey::gradient},
      {"reshape", StudioKey::reshape}, {"dry", StudioKey::dry},     {"fit", StudioKey::fit}};
  if (verb == "press") return Button{true};
  if (verb == "release") return Button{false};
  if (verb == "quit") return Quit{};
  if (verb == "move") {
    const auto x = number(words);
    const auto y = number(words);
    if (x && y) return MoveTo{*x, *y};
  } else if (verb == "pressure") {
    if (const auto p = number(words); p && *p >= 0 && *p <= 1) return Press{*p};
  } else if (verb == "zoom") {
    if (const auto factor = number(words); factor && *factor > 0) return Zoom{*factor};
  } else if (verb == "look") {
    static const std::map<std::string, Look> looks = {{"shaded", {TuftLook::shaded, false}},
                                                      {"colours", {TuftLook::colours, false}},
                                                      {"outline", {TuftLook::outline, false}},
                                                      {"off", {TuftLook::off, false}},
                                                      {"development", {TuftLook::outline, true}}};
    std::string name;
    words >> name;
    if (const auto look = looks.find(name); look != looks.end()) return look->second;
  } else if (verb == "key") {
    std::string name;
    words >> name;
    if (const auto key = keys.find(name); key != keys.end()) return key->second;
  } else if (verb == "save" || verb == "shot") {
    std::string file;
    if (!std::getline(words >> std::ws, file) || file.empty()) return std::nullopt;
    if (verb == "save") return SaveAs{file};
    return Shot{file};
  }
  return std::nullopt;
}

}  // namespace

Result<std::vector<ScriptedEvent>> read_script(const std::string& text, const std::string& source) {
  std::vector<ScriptedEvent> events;
  std::istringstream lines(text);
  std::string line;
  for (int at = 1; std::getline(lines, line); ++at) {
    std::istringstream words(line.substr(0, line.find('#')));
    if ((words >> std::ws).eof()) continue;
    const auto bad = [&](const std::string& why) {
      return failure(Fault::malformed, source + ", line " + std::to_string(at) + ": " + why);
    };
    const auto seconds = number(words);
    std::string verb;
    if (!seconds || *seconds < 0 || !(words >> verb)) return bad("write SECONDS EVENT, as '0.5 press'");
    const auto event = event_of(verb, words);
    if (!event) return bad("'" + verb + "' is no event here, or lacks its values");
    if (std::string rest; words >> rest) return bad("'" + rest + "' is too much");
    if (!events.empty() && *seconds < events.back().at_s) return bad("time runs backwards");
    events.push_back({*seconds, *event});
  }
  return events;
}

}  // namespace fude
