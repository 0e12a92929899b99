#include "rig/calibration/imu.h"

#include <CLI/CLI.hpp>
#include <memory>

#include "app/calibrate/procedure_command.h"
#include "app/calibrate/procedures.h"

namespace fude {

void add_calibrate_imu(CLI::App& calibrate, int& status) {
  auto wish = std::make_shared<ImuWish>();
  CLI::App* command =
      add_procedure(calibrate, status,
                    {"imu", "what an inertial unit's readings lack, from its sides and a tumble",
                     [wish](const KnownCalibrations&) { return imu_calibrator(*wish); }});
  command->add_option("--tool", wish->unit, "the inertial unit, where there are several");
}

}  // namespace fude
