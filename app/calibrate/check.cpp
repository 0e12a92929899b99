#include "rig/calibration/check.h"

#include <CLI/CLI.hpp>
#include <memory>

#include "app/calibrate/procedure_command.h"
#include "app/calibrate/procedures.h"

namespace fude {

void add_calibrate_check(CLI::App& calibrate, int& status) {
  auto wish = std::make_shared<CheckWish>();
  CLI::App* command =
      add_procedure(calibrate, status,
                    {"check",
                     "whether brush and paper are where they were, from three of the paper's corners touched",
                     [wish](KnownCalibrations known) { return check_calibrator(*wish, std::move(known)); },
                     {},
                     false});
  add_tool_options(*command, wish->tool);
  add_tip_option(*command, wish->tip_m);
}

}  // namespace fude
