#include "rig/fuse_geometry.h"

#include <toml++/toml.h>

#include <cmath>

namespace fude {
namespace {

std::optional<Eigen::Vector3d> vector_of(const toml::node* node) {
  const toml::array* array = node != nullptr ? node->as_array() : nullptr;
  if (array == nullptr || array->size() != 3) return std::nullopt;
  Eigen::Vector3d v;
  for (std::size_t i = 0; i < 3; ++i)
    v[static_cast<Eigen::Index>(i)] = array->get(i)->value<double>().value_or(std::nan(""));
  return v.allFinite() ? std::optional(v) : std::nullopt;
}

}  // namespace

Result<FuseGeometry> fuse_geometry(const Session& session) {
  FuseGeometry geometry;
  for (const RecordedCalibration& calibration : session.calibrations) {
    toml::table table;
    try {
      table = toml::parse(calibration.toml);
    } catch (const toml::parse_error& wrong) {
      return failure(Fault::malformed, "the session's calibration " + calibration.name +
                                           " cannot be read: " + std::string(wrong.description()));
    }
    if (const auto tip = vector_of(table.get("tip_m"))) geometry.tip_m = tip;
    if (const auto emitter = vector_of(table.get("emitter_m"))) geometry.emitter_m = emitter;
    const toml::node* receivers = table.get("receivers_m");
    if (receivers == nullptr || receivers->as_array() == nullptr) continue;
    geometry.receivers_m.clear();
    for (const toml::node& receiver : *receivers->as_array()) {
      const auto place = vector_of(&receiver);
      if (!place)
        return failure(Fault::malformed, "the session's calibration " + calibration.name +
                                             ": receivers_m are not [x, y, z] each");
      geometry.receivers_m.push_back(*place);
    }
  }
  return geometry;
}

}  // namespace fude
