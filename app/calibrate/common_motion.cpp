#include "rig/calibration/common_motion.h"

#include <CLI/CLI.hpp>
#include <memory>

#include "app/calibrate/procedure_command.h"
#include "app/calibrate/procedures.h"

namespace fude {

void add_calibrate_common_motion(CLI::App& calibrate, int& status) {
  auto wish = std::make_shared<CommonMotionWish>();
  CLI::App* command =
      add_procedure(calibrate, status,
                    {"common-motion", "where a tracker stands to another, from a motion that both saw",
                     [wish](const KnownCalibrations&) { return common_motion_calibrator(*wish); }});
  command->add_option("--tool", wish->tool, "the tool, where there are more than two");
  command->add_option("--other", wish->other, "the tool that the other tracker saw")->required();
}

}  // namespace fude
