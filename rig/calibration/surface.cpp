#include "rig/calibration/surface.h"

#include <utility>

#include "calibration/surface.h"
#include "rig/calibration/tool_calibrator.h"

namespace fude {

std::unique_ptr<Calibrator> surface_calibrator(SurfaceWish wish, KnownCalibrations known) {
  const auto begin = [wish, known = std::move(known)](const ChosenStream& tool) -> Result<SurfaceProcedure> {
    const auto tip = tip_of("surface", wish.tip_m, known, tool);
    if (!tip) return tl::unexpected(tip.error());
    return SurfaceProcedure(*tip, wish.corners_first);
  };
  return std::make_unique<ToolCalibrator<SurfaceProcedure>>(wish.tool, begin, &ToolPoses::sign_frame);
}

}  // namespace fude
