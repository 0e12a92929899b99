#include "tests/sim/ink/strokes.h"

#include <cmath>
#include <stdexcept>

namespace fude {

InkEvent pour(const Pour& what, double left_mm, double bottom_mm, double right_mm, double top_mm,
              double map_mm, const std::function<bool(double, double)>& inside, std::uint64_t id) {
  Deposit deposit;
  FootprintMap& map = deposit.map;
  map = {left_mm,
         bottom_mm,
         map_mm,
         static_cast<int>(std::ceil((right_mm - left_mm) / map_mm)),
         static_cast<int>(std::ceil((top_mm - bottom_mm) / map_mm)),
         {},
         {},
         {}};
  for (int y = 0; y < map.rows; ++y)
    for (int x = 0; x < map.columns; ++x) {
      const bool in = inside(left_mm + (x + 0.5) * map_mm, bottom_mm + (y + 0.5) * map_mm);
      map.fresh.push_back(in ? what.fresh : 0);
      map.contact_s.push_back(in ? what.contact_s : 0);
      map.patch.push_back(0);
    }
  deposit.patches.push_back({what.wetness, what.strength});
  return {Duration{}, id, deposit};
}

InkEvent pour_disc(const Pour& what, double x_mm, double y_mm, double radius_mm, std::uint64_t id) {
  return pour(
      what, x_mm - radius_mm, y_mm - radius_mm, x_mm + radius_mm, y_mm + radius_mm, 0.05,
      [=](double x, double y) {
        const double dx = x - x_mm;
        const double dy = y - y_mm;
        return dx * dx + dy * dy < radius_mm * radius_mm;
      },
      id);
}

std::unique_ptr<Ink> sheet(double side_mm, const std::function<void(InkSetup&)>& change) {
  InkSetup setup;
  setup.width_mm = setup.height_mm = side_mm;
  if (change) change(setup);
  auto ink = open_ink(setup);
  if (!ink) throw std::runtime_error(ink.error().message);
  return std::move(*ink);
}

void step(Ink& ink, int steps) {
  for (int i = 0; i < steps; ++i) ink.step();
}

}  // namespace fude
