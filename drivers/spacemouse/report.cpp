#include "drivers/spacemouse/report.h"

#include <algorithm>

namespace fude::spacemouse {
namespace {

constexpr std::uint8_t motion = 1;  // six bytes of push; in the wireless ones six of turn follow
constexpr std::uint8_t turning = 2;
constexpr std::uint8_t pressed = 3;
constexpr std::uint8_t charge = 0x17;

struct Row {
  std::uint16_t vendor;
  std::uint16_t product;
  Model model;
};
constexpr Row rows[] = {
#define SPACEMOUSE_MODEL(vendor, product, name, buttons, range_counts) \
  {vendor, product, {name, buttons, range_counts}},
#include "drivers/spacemouse/models.inl"
#undef SPACEMOUSE_MODEL
};

Eigen::Vector3i axes(Bytes report, std::size_t at) {
  return {little_endian<std::int16_t>(report, at), -little_endian<std::int16_t>(report, at + 2),
          -little_endian<std::int16_t>(report, at + 4)};
}

}  // namespace

Model model_of(std::uint16_t vendor, std::uint16_t product) {
  const Row* row = std::find_if(std::begin(rows), std::end(rows),
                                [&](const Row& r) { return r.vendor == vendor && r.product == product; });
  return row == std::end(rows) ? Model{"SpaceMouse", 32, 350} : row->model;
}

bool knows(std::uint8_t number) {
  return number == motion || number == turning || number == pressed || number == charge;
}

std::optional<Report> read_report(Bytes report) {
  if (report.size() < 2) return std::nullopt;
  Report read;
  switch (octet(report, 0)) {
    case motion:
      if (report.size() != 7 && report.size() != 13) return std::nullopt;
      read.push_counts = axes(report, 1);
      if (report.size() == 13) read.turn_counts = axes(report, 7);
      return read;
    case turning:
      if (report.size() != 7) return std::nullopt;
      read.turn_counts = axes(report, 1);
      return read;
    case pressed: {
      if (report.size() > 8) return std::nullopt;
      std::uint32_t buttons = 0;
      for (std::size_t i = 1; i < std::min<std::size_t>(report.size(), 5); ++i)
        buttons |= std::uint32_t{octet(report, i)} << (8 * (i - 1));
      read.buttons = buttons;
      return read;
    }
    case charge:
      read.battery_percent = octet(report, 1);
      return read;
    default:
      return std::nullopt;
  }
}

}  // namespace fude::spacemouse
