#include "rig/calibration/check.h"

#include <utility>

#include "calibration/rig_check.h"
#include "rig/calibration/tool_calibrator.h"

namespace fude {
namespace {

Result<RigCheckProcedure> begun(const CheckWish& wish, const KnownCalibrations& known,
                                const ChosenStream& tool) {
  const auto tip = tip_of("check", wish.tip_m, known, tool);
  if (!tip) return tl::unexpected(tip.error());
  const auto found = known.find("surface", tool, wish.tool.reference);
  if (!found) return tl::unexpected(found.error());
  const auto surface = *found ? surface_from((*found)->result) : std::nullopt;
  if (!surface)
    return failure(Fault::usage, "check needs the surface as it was calibrated: give --cal SURFACE.toml");
  const bool corners = numbers_in((*found)->report.details, "corners_off_rectangle_mm").has_value();
  return RigCheckProcedure(*surface, *tip, corners);
}

void sign(const ToolPoses& poses, CalibrationReport& report) {
  poses.sign_frame(report);
  report.tool = poses.tool()->part;
}

}  // namespace

std::unique_ptr<Calibrator> check_calibrator(CheckWish wish, KnownCalibrations known) {
  const auto begin = [wish, known = std::move(known)](const ChosenStream& tool) {
    return begun(wish, known, tool);
  };
  return std::make_unique<ToolCalibrator<RigCheckProcedure>>(wish.tool, begin, sign);
}

}  // namespace fude
