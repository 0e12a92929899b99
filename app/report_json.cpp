#include "app/report_json.h"

#include <nlohmann/json.hpp>

namespace fude {
namespace {

nlohmann::ordered_json as_json(const Quantiles& q) { return {{"median", q.median}, {"p99", q.p99}}; }

}  // namespace

nlohmann::ordered_json as_json(const ReplayReport& r) {
  const auto pigment = [&](const std::array<double, concentrations_per_group>& amounts) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < r.pigments.size(); ++i) list.push_back(amounts[i]);
    return list;
  };
  return {{"samples", r.samples},
          {"lost_samples", r.lost_samples},
          {"strokes", r.strokes},
          {"session_s", r.session_s},
          {"wall_s", r.wall_s},
          {"steps", r.steps},
          {"dt_s", r.dt_s},
          {"step_ms", as_json(r.step_ms)},
          {"backend", r.backend},
          {"isa", r.isa},
          {"threads", r.threads},
          {"peak_mb", r.peak_mb},
          {"pigments", r.pigments},
          {"picture_sha256", r.picture_sha256},
          {"water",
           {{"deposited", r.ink.water_deposited},
            {"evaporated", r.ink.water_evaporated},
            {"left", r.ink.water_left}}},
          {"pigment",
           {{"deposited", pigment(r.ink.pigment_deposited)},
            {"surface", pigment(r.ink.pigment_surface)},
            {"flow", pigment(r.ink.pigment_flow)},
            {"fixed", pigment(r.ink.pigment_fixed)}}},
          {"brush",
           {{"solves", r.solves.solves},
            {"unconverged", r.solves.unconverged},
            {"us_per_solve", as_json(r.us_per_solve)}}}};
}

}  // namespace fude
