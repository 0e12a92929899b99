// The commands of `fude calibrate`, one file each. A procedure's command has its own options beside those of
// all (app/calibrate/procedure_command.h).
#pragma once

namespace CLI {
class App;
}

namespace fude {

void add_calibrate_brush(CLI::App& calibrate, int& status);
void add_calibrate_camera(CLI::App& calibrate, int& status);
void add_calibrate_camera_pose(CLI::App& calibrate, int& status);
void add_calibrate_check(CLI::App& calibrate, int& status);
void add_calibrate_common_motion(CLI::App& calibrate, int& status);
void add_calibrate_distortion(CLI::App& calibrate, int& status);
void add_calibrate_delay(CLI::App& calibrate, int& status);
void add_calibrate_imu(CLI::App& calibrate, int& status);
void add_calibrate_imu_axes(CLI::App& calibrate, int& status);
void add_calibrate_list(CLI::App& calibrate, int& status);
void add_calibrate_pivot(CLI::App& calibrate, int& status);
void add_calibrate_pressure(CLI::App& calibrate, int& status);
void add_calibrate_rollback(CLI::App& calibrate, int& status);
void add_calibrate_surface(CLI::App& calibrate, int& status);
void add_calibrate_target(CLI::App& calibrate, int& status);
void add_calibrate_tracker(CLI::App& calibrate, int& status);

}  // namespace fude
