#include "rig/camera_report.h"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>

#include "capture/session_words.h"

namespace fude {
namespace {

constexpr double exposure_step_s = 1e-4;  // of UVC

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

std::string size_of(const CameraSettings& s) {
  return std::to_string(s.width) + " x " + std::to_string(s.height);
}

template <class T>
nlohmann::ordered_json or_null(const std::optional<T>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json();
}

}  // namespace

std::string camera_remark(const CameraSettings& asked, const CameraSettings& given) {
  std::string line;
  const auto differs = [&line](const std::string& wish, const std::string& made) {
    line += (line.empty() ? "asked for " : "; asked for ") + wish + ", " + made;
  };
  if (asked.format && asked.format != given.format)
    differs(std::string(word_for(*asked.format)), "gives " + std::string(word_for(*given.format)));
  if (asked.width != given.width || asked.height != given.height)
    differs(size_of(asked), "gives " + size_of(given));
  if (given.rate_hz <= 0)
    differs(number(asked.rate_hz) + " Hz", "does not say its rate");
  else if (std::abs(given.rate_hz - asked.rate_hz) > 0.01 * asked.rate_hz)
    differs(number(asked.rate_hz) + " Hz", "gives " + number(given.rate_hz) + " Hz");
  const auto exposure = [](double s) { return number(s * 1e3) + " ms"; };
  if (asked.exposure_s && !given.exposure_s)
    differs("an exposure of " + exposure(*asked.exposure_s), "cannot hold one");
  else if (asked.exposure_s && std::abs(*given.exposure_s - *asked.exposure_s) > exposure_step_s / 2)
    differs("an exposure of " + exposure(*asked.exposure_s), "holds " + exposure(*given.exposure_s));
  const auto control = [&differs](const char* name, std::optional<std::int32_t> wish,
                                  std::optional<std::int32_t> made) {
    if (wish && wish != made)
      differs(name + std::to_string(*wish), made ? "holds " + std::to_string(*made) : "has none");
  };
  control("gain ", asked.gain, given.gain);
  control("focus ", asked.focus, given.focus);
  return line;
}

std::string camera_record(const CameraSettings& given) {
  const nlohmann::ordered_json json{
      {"format", word_for(given.format.value())},
      {"width", given.width},
      {"height", given.height},
      {"rate_hz", or_null(given.rate_hz > 0 ? std::optional(given.rate_hz) : std::nullopt)},
      {"exposure_s", or_null(given.exposure_s)},
      {"gain", or_null(given.gain)},
      {"focus", or_null(given.focus)}};
  return json.dump();
}

}  // namespace fude
