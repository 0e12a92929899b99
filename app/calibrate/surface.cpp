#include "rig/calibration/surface.h"

#include <CLI/CLI.hpp>
#include <memory>

#include "app/calibrate/procedure_command.h"
#include "app/calibrate/procedures.h"

namespace fude {

void add_calibrate_surface(CLI::App& calibrate, int& status) {
  auto wish = std::make_shared<SurfaceWish>();
  CLI::App* command = add_procedure(
      calibrate, status,
      {"surface", "the painting surface and its paper, from touches of a calibrated tip",
       [wish](KnownCalibrations known) { return surface_calibrator(*wish, std::move(known)); }});
  add_tool_options(*command, wish->tool);
  add_tip_option(*command, wish->tip_m);
  command->add_flag("--corners", wish->corners_first,
                    "the first four touches are the paper's corners, lower left first, counter-clockwise");
}

}  // namespace fude
