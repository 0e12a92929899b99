// The reports of a SpaceMouse as they stand on the wire (firmware-notes/spacemouse.md).
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "drivers/byte_order.h"

namespace fude::spacemouse {

struct Model {
  const char* name;
  unsigned buttons;  // bits of the button report that mean something
  int range_counts;
};

// By models.inl; a product that is in no row has 32 buttons and a range of 350 counts.
Model model_of(std::uint16_t vendor, std::uint16_t product);

// What one report says; the rest stands as it was. In counts, in fude's frame: x right, y away from the
// user, z up, turns right-handed (the wire has y towards the user and z down).
struct Report {
  std::optional<Eigen::Vector3i> push_counts;
  std::optional<Eigen::Vector3i> turn_counts;
  std::optional<std::uint32_t> buttons;
  std::optional<unsigned> battery_percent;
};

bool knows(std::uint8_t number);

// None where the number is not known or the length is not that of its report.
std::optional<Report> read_report(Bytes report);

}  // namespace fude::spacemouse
