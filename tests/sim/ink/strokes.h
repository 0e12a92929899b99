// Ink laid on a sheet without a brush: discs and bars, for the tests.
#pragma once

#include <functional>

#include "sim/ink/ink.h"

namespace fude {

struct Pour {
  float wetness = 1;
  Concentrations strength{1, 0, 0, 0};
  float fresh = 1;
  float contact_s = 0;
};

// Everything inside the shape, sampled at map cells of map_mm in [left, right] × [bottom, top].
InkEvent pour(const Pour& what, double left_mm, double bottom_mm, double right_mm, double top_mm,
              double map_mm, const std::function<bool(double x_mm, double y_mm)>& inside,
              std::uint64_t id = 1);

InkEvent pour_disc(const Pour& what, double x_mm, double y_mm, double radius_mm, std::uint64_t id = 1);

// A sheet of `side` millimetres; throws where it cannot be opened.
std::unique_ptr<Ink> sheet(double side_mm, const std::function<void(InkSetup&)>& change = {});

void step(Ink& ink, int steps);

}  // namespace fude
