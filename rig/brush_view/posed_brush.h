// A brush led to a pose as a hand would: down from above, solved all the way, and held there.
#pragma once

#include <Eigen/Core>

#include "signal/action.h"
#include "signal/pose.h"
#include "signal/result.h"
#include "sim/brush/brush.h"
#include "sim/brush/mark.h"

namespace fude {

struct PosedBrush {
  Brush brush;
  Mark mark;
  int frames = 0;
  int unconverged = 0;
  SolveReport last;
};

// The handle at x, y, z (mm, of the root of the hair), its upper end leaning by `lean` towards `towards`
// (from +x, counterclockwise), spun by `spin` about itself. Radians.
Pose<Paper, Handle> handle_pose(const Eigen::Vector3d& at_mm, double lean, double towards, double spin);

// Errors: usage, for a pose that is not finite or farther than a metre from the paper's origin.
Result<PosedBrush> lead_to(const BrushSpec& spec, const Pose<Paper, Handle>& paper_from_handle,
                           const LoadBrush& load);

// The brush of `posed` led on to the right by `mm`, with a press and a lift, as a short stroke.
void draw_stroke(PosedBrush& posed, double mm);

}  // namespace fude
