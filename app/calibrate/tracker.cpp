#include "rig/calibration/tracker.h"

#include <CLI/CLI.hpp>
#include <memory>

#include "app/calibrate/procedure_command.h"
#include "app/calibrate/procedures.h"

namespace fude {

void add_calibrate_tracker(CLI::App& calibrate, int& status) {
  auto wish = std::make_shared<TrackerWish>();
  CLI::App* command =
      add_procedure(calibrate, status,
                    {"tracker", "where a tracker stands, from landmarks that are touched or were measured",
                     [wish](KnownCalibrations known) { return tracker_calibrator(*wish, std::move(known)); },
                     [wish] { return !wish->measured; }});
  add_tool_options(*command, wish->tool);
  add_tip_option(*command, wish->tip_m);
  command
      ->add_option("--landmarks", wish->landmarks,
                   "a list of name,x,y,z in mm of the reference, touched in its order")
      ->required();
  command->add_option("--measured", wish->measured,
                      "the same points as the tracker has them, in mm, instead of touches");
}

}  // namespace fude
