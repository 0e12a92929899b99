// The load under which this machine is measured: a sheet of 512 × 512 wet cells, stepped in real time while a
// pen draws on it.
#pragma once

#include <functional>
#include <memory>

#include "calibration/pen_mapping.h"
#include "rig/live_painting.h"
#include "rig/painting.h"
#include "signal/result.h"

namespace fude {

class WetSheet {
 public:
  // The sheet of `wanted` gives way to one of 512 × 512 of its cells. Errors: those of the ink's back-end.
  static Result<std::unique_ptr<WetSheet>> open(const PaintingSetup& wanted);

  // Draws in real time on the calling thread, a stroke a second, 200 reports a second; `reported` comes after
  // each. Returns how many there were.
  int draw(double seconds, const std::function<void()>& reported = {});

  // Stops the ink; nothing is drawn after it.
  const Painting& stop() { return live_.stop().painting(); }

  // As of LivePainting, after stop().
  const std::vector<double>& latencies_ms() const { return live_.latencies_ms(); }

 private:
  WetSheet(Painting painting, const PenReach& reach, double side_mm);

  double side_mm_;
  TabletMapping mapping_;
  LivePainting live_;
  int reports_ = 0;
};

}  // namespace fude
