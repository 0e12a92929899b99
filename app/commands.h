// The commands of `fude`, one file each. A command adds itself to the command line; when it was
// chosen, its callback sets the exit status: 0 done, 1 the work failed, 2 wrong usage, 130 Ctrl-C.
#pragma once

#include <string>

#include "signal/result.h"

namespace CLI {
class App;
}

namespace fude {

void add_bench(CLI::App& fude, int& status);
void add_brushes(CLI::App& fude, int& status);
void add_calibrate(CLI::App& fude, int& status);
void add_demo(CLI::App& fude, int& status);
void add_devices(CLI::App& fude, int& status);
void add_doctor(CLI::App& fude, int& status);
void add_export(CLI::App& fude, int& status);
void add_fuse(CLI::App& fude, int& status);
void add_import(CLI::App& fude, int& status);
void add_info(CLI::App& fude, int& status);
void add_monitor(CLI::App& fude, int& status);
void add_paint(CLI::App& fude, int& status);
void add_perform(CLI::App& fude, int& status);
void add_play(CLI::App& fude, int& status);
void add_record(CLI::App& fude, int& status);
void add_replay(CLI::App& fude, int& status);
void add_serve(CLI::App& fude, int& status);

// One line on standard error, and the status that goes with it.
int report(const Error& error);

}  // namespace fude
