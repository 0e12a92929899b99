#include "drivers/joycon/calibration.h"

#include <algorithm>
#include <numbers>

namespace fude::joycon {
namespace {

constexpr double gravity_mps2 = 9.80665;
constexpr double radians_per_degree = std::numbers::pi / 180;

struct Model {
  std::uint16_t product;
  double acceleration_g;
  double turn_rate_degps;
};
constexpr Model models[] = {
#define JOYCON_MODEL(product, name, acceleration_g, turn_rate_degps) \
  {product, acceleration_g, turn_rate_degps},
#include "drivers/joycon/models.inl"
#undef JOYCON_MODEL
};

Eigen::Vector3d vector(const std::array<std::int16_t, 3>& axes) {
  return {double(axes[0]), double(axes[1]), double(axes[2])};
}

Eigen::Vector3d three(Bytes flash, std::size_t at) {
  return vector({little_endian<std::int16_t>(flash, at), little_endian<std::int16_t>(flash, at + 2),
                 little_endian<std::int16_t>(flash, at + 4)});
}

}  // namespace

Eigen::Vector3d InertialScale::specific_force_mps2(const InertialCounts& counts) const {
  return vector(counts.acceleration).cwiseProduct(acceleration_mps2);
}

Eigen::Vector3d InertialScale::turn_rate_of(const InertialCounts& counts) const {
  return (vector(counts.turn_rate) - turn_rate_zero).cwiseProduct(turn_rate_radps);
}

InertialScale nominal_scale(std::uint16_t product) {
  const Model* model = std::find_if(std::begin(models), std::end(models),
                                    [&](const Model& m) { return m.product == product; });
  if (model == std::end(models)) model = models;
  return {Eigen::Vector3d::Constant(model->acceleration_g * gravity_mps2),
          Eigen::Vector3d::Constant(model->turn_rate_degps * radians_per_degree), Eigen::Vector3d::Zero()};
}

// Origin and count at the reference for the accelerometer, then for the gyroscope: 4 g and 936 deg/s lie
// between the two. The accelerometer's origin is what it reads when lying flat, so it is no zero.
std::optional<InertialScale> read_calibration(Bytes flash) {
  if (flash.size() < calibration_length) return std::nullopt;
  const Eigen::Vector3d acceleration_span = three(flash, 6) - three(flash, 0);
  const Eigen::Vector3d turn_rate_span = three(flash, 18) - three(flash, 12);
  const auto plausible = [](const Eigen::Vector3d& span, double usual) {
    return span.minCoeff() > usual / 2 && span.maxCoeff() < usual * 2;
  };
  if (!plausible(acceleration_span, 0x4000) || !plausible(turn_rate_span, 0x343b)) return std::nullopt;
  return InertialScale{4 * gravity_mps2 * acceleration_span.cwiseInverse(),
                       936 * radians_per_degree * turn_rate_span.cwiseInverse(), three(flash, 12)};
}

}  // namespace fude::joycon
