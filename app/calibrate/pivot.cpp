#include "rig/calibration/pivot.h"

#include <CLI/CLI.hpp>
#include <memory>

#include "app/calibrate/procedure_command.h"
#include "app/calibrate/procedures.h"

namespace fude {

void add_calibrate_pivot(CLI::App& calibrate, int& status) {
  auto wish = std::make_shared<PivotWish>();
  CLI::App* command =
      add_procedure(calibrate, status,
                    {"pivot", "the tip of a brush, from turning about it",
                     [wish](KnownCalibrations known) { return pivot_calibrator(*wish, std::move(known)); }});
  add_tool_options(*command, wish->tool);
  command->add_option("--spin", wish->spin, "a session in which the handle is spun about itself");
}

}  // namespace fude
