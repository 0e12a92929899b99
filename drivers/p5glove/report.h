// The reports of a P5 Glove as they stand on the wire (firmware-notes/p5glove.md).
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>

#include "drivers/byte_order.h"

namespace fude::p5glove {

inline constexpr std::size_t report_length = 24;
inline constexpr std::uint8_t heads_number = 6;    // the feature report on the tower's two heads
inline constexpr std::uint8_t lights_number = 12;  // the one on the glove's kind and lights

// What the tower sees of one light: tangents in 1/512, as the two heads look up and both look sideways.
struct Sighting {
  std::uint8_t light = 0;  // 0 to 7
  std::array<std::int32_t, 2> vertical{};
  std::int32_t horizontal = 0;
};

struct Report {
  std::array<std::uint8_t, 5> bend{};  // 0 to 63: index, middle, ring, little finger, thumb
  std::uint8_t buttons = 0;            // bit 0 A, 1 B, 2 C
  std::array<std::optional<Sighting>, 4> sightings{};
};

// None for another length or number.
std::optional<Report> read_report(Bytes report);

// How the tower stands: its heads one above the other, each tilted.
struct Tower {
  std::array<double, 2> tilt_rad{};
  double distance_m = 0;  // between the heads
};

// From feature reports 6 and 12; none where they are short, the kind of glove is not known (its heads'
// tilt is not in the reports), or the heads would stand in one place.
std::optional<Tower> read_tower(Bytes heads, Bytes lights);

// In the tower's frame: origin between its heads, y up, z out of the tower, x to its left as it looks; m.
// None where the two views do not meet within five metres in front of it.
std::optional<Eigen::Vector3d> place_of(const Sighting& sighting, const Tower& tower);

}  // namespace fude::p5glove
