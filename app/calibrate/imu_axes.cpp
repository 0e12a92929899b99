#include "rig/calibration/imu_axes.h"

#include <CLI/CLI.hpp>
#include <memory>

#include "app/calibrate/procedure_command.h"
#include "app/calibrate/procedures.h"

namespace fude {

void add_calibrate_imu_axes(CLI::App& calibrate, int& status) {
  auto wish = std::make_shared<ImuAxesWish>();
  CLI::App* command =
      add_procedure(calibrate, status,
                    {"imu-axes", "how an inertial unit's axes lie to the markers on the same handle",
                     [wish](const KnownCalibrations&) { return imu_axes_calibrator(*wish); }});
  command->add_option("--tool", wish->tool, "the tool of the tracker, where it has several");
  command->add_option("--imu", wish->unit, "the inertial unit, where there are several");
}

}  // namespace fude
