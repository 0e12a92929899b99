#include "drivers/p5glove/report.h"

#include <cmath>
#include <numbers>

#include "signal/elementary.h"

namespace fude::p5glove {
namespace {

constexpr double radians_per_degree = std::numbers::pi / 180;
constexpr double tangent_counts = 512;
constexpr double farthest_m = 5;

// `width` bits, the highest first, from bit `at` of the report, whose first bit is the highest of byte 0.
std::uint32_t bits(Bytes report, std::size_t at, std::size_t width) {
  std::uint32_t value = 0;
  for (std::size_t i = at; i < at + width; ++i)
    value = value << 1 | (octet(report, i / 8) >> (7 - i % 8) & 1u);
  return value;
}

std::int32_t signed_ten_bits(Bytes report, std::size_t at) {
  const auto value = static_cast<std::int32_t>(bits(report, at, 10));
  return value >= 512 ? value - 1024 : value;
}

}  // namespace

std::optional<Report> read_report(Bytes report) {
  if (report.size() != report_length || octet(report, 0) != 1) return std::nullopt;
  Report read;
  for (std::size_t i = 0; i < 5; ++i) read.bend[i] = static_cast<std::uint8_t>(bits(report, 8 + 6 * i, 6));
  read.buttons = static_cast<std::uint8_t>(bits(report, 40, 4));
  for (std::size_t i = 0; i < 4; ++i) {
    const std::uint32_t light = bits(report, 44 + 4 * i, 4);
    if (light > 7) continue;  // nothing seen
    const std::size_t at = 60 + 30 * i;
    read.sightings[i] = Sighting{static_cast<std::uint8_t>(light),
                                 {signed_ten_bits(report, at + 10), signed_ten_bits(report, at)},
                                 signed_ten_bits(report, at + 20)};
  }
  return read;
}

std::optional<Tower> read_tower(Bytes heads, Bytes lights) {
  if (heads.size() < 6 || octet(heads, 0) != heads_number) return std::nullopt;
  if (lights.size() < 2 || octet(lights, 0) != lights_number) return std::nullopt;
  constexpr std::uint8_t usual_kind = 0;
  if (octet(lights, 1) != usual_kind) return std::nullopt;
  const auto tilt = [&](std::size_t at, double usual_degrees) {
    return (usual_degrees + static_cast<std::int8_t>(octet(heads, at)) / 32.0) * radians_per_degree;
  };
  Tower tower;
  tower.tilt_rad = {tilt(1, 17), tilt(3, -10)};
  tower.distance_m = octet(heads, 5) * 0.00254;  // tenths of an inch
  if (tower.distance_m <= 0) return std::nullopt;
  return tower;
}

std::optional<Eigen::Vector3d> place_of(const Sighting& sighting, const Tower& tower) {
  const auto rise = [&](std::size_t head) {
    return elementary::tangent(elementary::arctangent(sighting.vertical[head] / tangent_counts) +
                               tower.tilt_rad[head]);
  };
  const double lower = rise(0);
  const double upper = rise(1);
  const double far = tower.distance_m / (lower - upper);  // along the floor
  if (!(far > 0 && far < farthest_m)) return std::nullopt;
  const auto side = elementary::sine_cosine(elementary::arctangent(sighting.horizontal / tangent_counts));
  const Eigen::Vector3d place(-side.sine * far, lower * far - tower.distance_m / 2, side.cosine * far);
  if (!(place.norm() < farthest_m)) return std::nullopt;
  return place;
}

}  // namespace fude::p5glove
