#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "app/commands.h"

namespace fude {

int report(const Error& error) {
  std::fprintf(stderr, "fude: %s\n", error.message.c_str());
  return error.fault == Fault::usage ? 2 : 1;
}

}  // namespace fude

int main(int argc, char** argv) {
  int status = 0;
  CLI::App app{"fude paints with real brushes on simulated paper"};
  app.set_version_flag("--version", "fude 0.1.0");
  app.require_subcommand(1);
  app.option_defaults()->always_capture_default();
  fude::add_demo(app, status);
  fude::add_replay(app, status);
  fude::add_fuse(app, status);
  fude::add_import(app, status);
  fude::add_export(app, status);
  fude::add_perform(app, status);
  fude::add_info(app, status);
  fude::add_devices(app, status);
  fude::add_doctor(app, status);
  fude::add_monitor(app, status);
  fude::add_record(app, status);
  fude::add_serve(app, status);
  fude::add_play(app, status);
  fude::add_calibrate(app, status);
  fude::add_brushes(app, status);
  fude::add_bench(app, status);
#ifdef FUDE_WINDOW
  fude::add_paint(app, status);
#endif
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& done) {
    return app.exit(done);
  } catch (const CLI::ParseError& wrong) {
    std::fprintf(stderr, "fude: %s. Try 'fude --help'.\n", wrong.what());
    return 2;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "fude: %s\n", e.what());
    return 1;
  }
  return status;
}
