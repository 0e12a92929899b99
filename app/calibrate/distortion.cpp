#include "rig/calibration/distortion.h"

#include <CLI/CLI.hpp>
#include <memory>

#include "app/calibrate/procedure_command.h"
#include "app/calibrate/procedures.h"

namespace fude {

void add_calibrate_distortion(CLI::App& calibrate, int& status) {
  auto wish = std::make_shared<DistortionWish>();
  CLI::App* command = add_procedure(
      calibrate, status,
      {.name = "distortion",
       .finds = "how iron bends what a magnetic tracker says, through the volume that was mapped",
       .make = [wish](KnownCalibrations known) { return distortion_calibrator(*wish, std::move(known)); },
       .undistorted = false});
  command->add_option("--tool", wish->tool, "the tool of the magnetic tracker, where there are several");
  command->add_option("--other", wish->other, "the same motion as a tracker saw it that no iron disturbs");
  command->add_option("--landmarks", wish->grid,
                      "instead: a list of name,x,y,z in mm of a grid, touched in its order");
  add_tip_option(*command, wish->tip_m);
}

}  // namespace fude
