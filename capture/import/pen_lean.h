// A pen's lean from two angles to two others.
#pragma once

#include "signal/elementary.h"
#include "signal/pen_sample.h"

namespace fude {

// `altitude` between the pen and the tablet, 0 to a right angle; `azimuth` of its upper end, from right (0)
// by way of the painter (a quarter turn). Sets tilt_x and tilt_y with the signs of PenSample.
inline void lean_by(PenSample& pen, double altitude_rad, double azimuth_rad) {
  const elementary::SineCosine up = elementary::sine_cosine(altitude_rad);
  const elementary::SineCosine around = elementary::sine_cosine(azimuth_rad);
  pen.tilt_x = Radians(elementary::arctangent(around.cosine * up.cosine, up.sine));
  pen.tilt_y = Radians(elementary::arctangent(around.sine * up.cosine, up.sine));
}

}  // namespace fude
