#include <CLI/CLI.hpp>
#include <string>

#include "app/calibrate/procedures.h"
#include "app/commands.h"

namespace fude {
namespace {

using AddCommand = void (*)(CLI::App& calibrate, int& status);
constexpr AddCommand commands[] = {
    add_calibrate_pivot,      add_calibrate_surface,     add_calibrate_tracker,  add_calibrate_common_motion,
    add_calibrate_distortion, add_calibrate_imu,         add_calibrate_imu_axes, add_calibrate_delay,
    add_calibrate_pressure,
#ifdef FUDE_VISION
    add_calibrate_camera,     add_calibrate_camera_pose, add_calibrate_target,
#endif
    add_calibrate_brush,      add_calibrate_check,       add_calibrate_list,     add_calibrate_rollback,
};

}  // namespace

void add_calibrate(CLI::App& app, int& status) {
  CLI::App* command =
      app.add_subcommand("calibrate", "finds where the brush and the paper are, and how sure that is");
  for (const AddCommand add : commands) add(*command, status);
  command->callback([command, &status] {
    if (!command->get_subcommands().empty()) return;
    std::string names;
    for (const CLI::App* what : command->get_subcommands({}))
      names += (names.empty() ? "" : ", ") + what->get_name();
    status = report({Fault::usage, "say what: fude calibrate WHAT, of " + names});
  });
}

}  // namespace fude
