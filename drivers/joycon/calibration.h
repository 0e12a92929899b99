// What one count of a Joy-Con's inertial unit is: nominal, or as its flash says.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "drivers/byte_order.h"
#include "drivers/joycon/report.h"

namespace fude::joycon {

inline constexpr std::size_t calibration_length = 24;

struct InertialScale {
  Eigen::Vector3d acceleration_mps2;  // a count
  Eigen::Vector3d turn_rate_radps;    // a count
  Eigen::Vector3d turn_rate_zero;     // counts when still

  Eigen::Vector3d specific_force_mps2(const InertialCounts& counts) const;
  Eigen::Vector3d turn_rate_of(const InertialCounts& counts) const;
};

// By models.inl; an unknown product has the figures of the Joy-Con (L).
InertialScale nominal_scale(std::uint16_t product);

// The 24 bytes at 0x6020, or those behind the mark at 0x8026. None where they are blank or would make a
// count more than twice or less than half the usual.
std::optional<InertialScale> read_calibration(Bytes flash);

}  // namespace fude::joycon
