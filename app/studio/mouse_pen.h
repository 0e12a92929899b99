// The mouse as a pen: no pressure, no tilt. Pressure is a number the painter sets; the session calls the
// device a mouse.
#pragma once

#include <Eigen/Core>

#include "calibration/pen_mapping.h"
#include "signal/device.h"
#include "signal/pen_sample.h"

namespace fude {

// A tablet as large as the sheet, a hundred counts to the millimetre.
DeviceDescription mouse_description(Extent sheet);

struct MousePen {
  Extent sheet;
  bool over_paper = false;
  bool pressed = false;
  double pressure = 0.5;
  Eigen::Vector2d at_mm = Eigen::Vector2d::Zero();
  std::uint64_t sequence = 0;

  // Its present state as the report of a pen.
  PenSample sample(Timestamp now);
};

}  // namespace fude
