#include "rig/calibration/delay.h"

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/calibrate/procedure_command.h"
#include "app/calibrate/procedures.h"

namespace fude {

void add_calibrate_delay(CLI::App& calibrate, int& status) {
  auto streams = std::make_shared<std::vector<std::string>>();
  auto tip_m = std::make_shared<std::optional<Eigen::Vector3d>>();
  CLI::App* command =
      add_procedure(calibrate, status,
                    {"delay", "the time between two streams, from touches or a motion that both see",
                     [streams, tip_m](KnownCalibrations known) -> Result<std::unique_ptr<Calibrator>> {
                       auto wish = delay_wish(*streams);
                       if (!wish) return tl::unexpected(wish.error());
                       wish->tip_m = *tip_m;
                       return delay_calibrator(std::move(*wish), std::move(known));
                     }});
  command
      ->add_option("--streams", *streams,
                   "A,B as `fude info` names them; the offset is added to B's times (or once for each)")
      ->required()
      ->take_all()
      ->expected(1);
  add_tip_option(*command, *tip_m);
}

}  // namespace fude
