#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>

#include "app/commands.h"
#include "app/painting_options.h"
#include "app/progress_line.h"
#include "rig/share_folder.h"
#include "sim/optics/png_file.h"
#ifdef FUDE_WINDOW
#include "app/studio/studio.h"
#endif

namespace fude {
namespace {

// A name that is free: fude-demo.png, fude-demo-2.png …
std::string free_name() {
  std::error_code ignored;
  std::string name = "fude-demo.png";
  for (int i = 2; std::filesystem::exists(name, ignored); ++i)
    name = "fude-demo-" + std::to_string(i) + ".png";
  return name;
}

Result<void> paint_into_picture(const Session& session, const ReplaySettings& settings) {
  auto replayed = [&] {
    const ProgressLine line("painting");
    return replay(session, settings, [&](double share) { line.show(share); });
  }();
  if (!replayed) return tl::unexpected(replayed.error());
  const std::string name = free_name();
  if (auto r = write_png(name, replayed->picture); !r) return r;
  std::printf("painted %s (%d x %d pixels, %.1f s of brushwork)\n", name.c_str(), replayed->picture.width,
              replayed->picture.height, replayed->report.session_s);
  return {};
}

Result<void> run(const std::string& name, const PaintingOptions& options) {
  const auto file = find_shared("sessions", name, ".fude");
  if (!file) return tl::unexpected(file.error());
  const auto session = read_session(*file);
  if (!session) return tl::unexpected(session.error());
  const auto settings = options.settings(session->settings);
  if (!settings) return tl::unexpected(settings.error());
#ifdef FUDE_WINDOW
  const auto is_set = [](const char* variable) {
    const char* value = std::getenv(variable);
    return value && *value;
  };
  if (is_set("DISPLAY") || is_set("WAYLAND_DISPLAY"))
    return run_studio({.settings = *settings, .played = *session, .script = {}, .out = {}, .picture = {}});
#endif
  return paint_into_picture(*session, *settings);
}

}  // namespace

void add_demo(CLI::App& app, int& status) {
  auto options = std::make_shared<PaintingOptions>();
  auto name = std::make_shared<std::string>("yong");
  options->settle = "4";
  CLI::App* command =
      app.add_subcommand("demo",
                         "paints a recorded performance: in a window where there is a display, "
                         "else into a picture");
  command->add_option("NAME", *name, "yong: 永, or bamboo");
  options->add_to(*command);
  command->callback([name, options, &status] {
    if (const auto done = run(*name, *options); !done) status = report(done.error());
  });
}

}  // namespace fude
