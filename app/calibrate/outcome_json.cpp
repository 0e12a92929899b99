#include "app/calibrate/outcome_json.h"

#include <nlohmann/json.hpp>
#include <optional>
#include <variant>

namespace fude {
namespace {

nlohmann::ordered_json as_json(const Fields& fields) {
  nlohmann::ordered_json object = nlohmann::ordered_json::object();
  for (const Field& field : fields)
    object[field.key] =
        std::visit([](const auto& value) { return nlohmann::ordered_json(value); }, field.value);
  return object;
}

template <class T>
nlohmann::ordered_json or_null(const std::optional<T>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json();
}

}  // namespace

std::string json_of(const CalibrationOutcome& outcome) {
  const CalibrationReport& r = outcome.report;
  const nlohmann::ordered_json json{
      {"procedure", r.procedure},
      {"accepted", r.accepted},
      {"reason", r.reason},
      {"unit", r.unit},
      {"rms", r.rms},
      {"rms_per_coordinate", r.rms_per_coordinate},
      {"p95", r.p95},
      {"max", r.max},
      {"held_out_rms", or_null(r.held_out_rms)},
      {"n", r.n},
      {"ci95", or_null(r.ci95)},
      {"condition", or_null(r.condition)},
      {"warnings", r.warnings},
      {"to_frame", r.to_frame},
      {"from_frame", r.from_frame},
      {"date", r.date},
      {"devices", r.devices},
      {"tool", r.tool},
      {"reference", r.reference},
      {"session", r.session},
      {"result", outcome.result ? as_json(*outcome.result) : nlohmann::ordered_json()},
      {"details", as_json(r.details)}};
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace fude
