// The fused pose of a recorded session: its samples handed to calibration/fusion.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <set>
#include <vector>

#include "capture/session.h"
#include "rig/fusion/fuse_sources.h"
#include "rig/fusion/fused_table.h"
#include "signal/result.h"

namespace fude {

struct FuseWish {
  std::optional<std::set<FuseSource>> use;        // none: all that the session has, but not its optical truth
  bool smooth = false;                            // from the samples after each moment too
  std::optional<Eigen::Vector3d> up;              // in the frame of the tracker; none: by gravity, else its z
  std::vector<RecordedCalibration> calibrations;  // beside those that the session carries
};

// Earth (east, north, up) is the world where orientation alone is asked for or the truth's positions are
// used, else the paper where one is calibrated, else the tracker's frame; metres. Ranges need receivers_m and
// emitter_m, contacts tip_m in a calibration. Errors: those of fuse_calibration(); usage where a source that
// was named is not there; not_found where nothing is.
Result<FusedSession> fuse_session(const Session& session, const FuseWish& wish);

}  // namespace fude
