#include "rig/fusion/fuse_geometry.h"

#include <toml++/toml.h>

#include <cmath>
#include <utility>

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

Result<std::vector<Eigen::Vector3d>> places_of(const toml::array& array, const std::string& calibration,
                                               const char* key) {
  std::vector<Eigen::Vector3d> places;
  for (const toml::node& node : array) {
    const auto place = vector_of(&node);
    if (!place)
      return failure(Fault::malformed,
                     "the calibration " + calibration + ": " + key + " are not [x, y, z] each");
    places.push_back(*place);
  }
  return places;
}

}  // namespace

Result<FuseGeometry> fuse_geometry(const std::vector<RecordedCalibration>& calibrations) {
  FuseGeometry geometry;
  for (const RecordedCalibration& calibration : calibrations) {
    toml::table table;
    try {
      table = toml::parse(calibration.toml);
    } catch (const toml::parse_error& wrong) {
      return failure(Fault::malformed, "the calibration " + calibration.name +
                                           " cannot be read: " + std::string(wrong.description()));
    }
    if (const auto tip = vector_of(table.get("tip_m"))) geometry.tip_m = tip;
    for (const auto& [key, places] :
         {std::pair("emitter_m", &geometry.emitters_m), std::pair("receivers_m", &geometry.receivers_m)}) {
      const toml::array* array = table.get_as<toml::array>(key);
      if (array == nullptr) continue;
      if (const auto one = vector_of(array)) {
        *places = {*one};
        continue;
      }
      auto several = places_of(*array, calibration.name, key);
      if (!several) return tl::unexpected(several.error());
      *places = std::move(*several);
    }
  }
  return geometry;
}

}  // namespace fude
