#include <CLI/CLI.hpp>

#include "app/calibrate/procedures.h"
#include "app/commands.h"

namespace fude {
namespace {

using AddCommand = void (*)(CLI::App& calibrate, int& status);
constexpr AddCommand commands[] = {
    add_calibrate_pivot,  add_calibrate_surface,  add_calibrate_tracker, add_calibrate_imu,
#ifdef FUDE_VISION
    add_calibrate_camera,
#endif
    add_calibrate_list,   add_calibrate_rollback,
};

}  // namespace

void add_calibrate(CLI::App& app, int& status) {
  CLI::App* command =
      app.add_subcommand("calibrate", "finds where the brush and the paper are, and how sure that is");
  command->require_subcommand(1);
  for (const AddCommand add : commands) add(*command, status);
}

}  // namespace fude
