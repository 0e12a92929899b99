// What fusion costs on this machine.
#pragma once

namespace fude {

struct FusionBench {
  double ns_per_orientation = 0;  // an update of OrientationFilter with a magnetometer; medians all
  double ns_per_inertial = 0;     // of Fusion, without fixes
  double ns_per_position = 0;     // a point fix in time
  double us_per_late = 0;         // a point fix that comes 50 ms late at 1 kHz
  double core_share = 0;          // 1 kHz inertial samples and 100 Hz positions
};

FusionBench bench_fusion();

}  // namespace fude
