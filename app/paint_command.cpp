#include <CLI/CLI.hpp>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "app/commands.h"
#include "app/painting_options.h"
#include "app/progress_line.h"
#include "app/studio/studio.h"
#include "rig/calibration/calibration_store.h"

namespace fude {
namespace {

struct Options {
  PaintingOptions painting;
  std::string session, on, script, out, picture;
  bool force = false;
};

Result<std::vector<ScriptedEvent>> load_script(const std::string& file) {
  std::ifstream in(file);
  if (!in) return failure(Fault::not_found, "cannot open the script " + file);
  std::ostringstream text;
  text << in.rdbuf();
  return read_script(text.str(), file);
}

// Those that are kept, and after them, as a later one counts, those by which the sheet was painted so far.
std::vector<StoredCalibration> calibrations_for_the_hand(const std::optional<Session>& before) {
  std::vector<std::string> unreadable;
  auto calibrations = calibrations_of_user(unreadable);
  if (before)
    for (const RecordedCalibration& carried : before->calibrations)
      if (auto calibration = calibration_from_toml(carried.toml, carried.name))
        calibrations.push_back(std::move(*calibration));
  return calibrations;
}

Result<void> run(const Options& options) {
  StudioSetup setup;
  if (!options.session.empty()) {
    auto session = read_session(options.session);
    if (!session) return tl::unexpected(session.error());
    setup.played = std::move(*session);
  }
  std::optional<Session> before;
  if (!options.on.empty()) {
    auto session = read_session(options.on);
    if (!session) return tl::unexpected(session.error());
    before = std::move(*session);
  }
  RecordedSettings recorded{{"manner", "hand"}};  // of a new painting
  if (before) {
    recorded = before->settings;
    recorded["manner"] = "hand";
  }
  if (setup.played) recorded = setup.played->settings;
  auto settings = options.painting.settings(recorded);
  if (!settings) return tl::unexpected(settings.error());
  setup.settings = std::move(*settings);
  if (before) {
    const ProgressLine line("painting what was there");
    // Painted as it was held then, however the brush is held now.
    ReplaySettings then = setup.settings;
    const auto manner = before->settings.find("manner");
    then.wish.manner = {};
    if (const auto held =
            manner == before->settings.end() ? Result<PenManner>() : parse_manner(manner->second))
      then.wish.manner = *held;
    auto sheet = painted_sheet(*before, then, [&](double share) { line.show(share); });
    if (!sheet) return tl::unexpected(sheet.error());
    setup.settings.wish.sheet =
        Extent{Millimetres(sheet->columns * sheet->cell_mm), Millimetres(sheet->rows * sheet->cell_mm)};
    setup.sheet = std::move(*sheet);
  } else if (setup.played && setup.played->sheet) {
    auto sheet = sheet_from_bytes(setup.played->sheet->state);
    if (!sheet) return tl::unexpected(sheet.error());
    setup.sheet = std::move(*sheet);
  }
  if (options.painting.calibrations.empty() && !setup.played)
    setup.settings.wish.calibrations = calibrations_for_the_hand(before);
  if (!options.script.empty()) {
    auto script = load_script(options.script);
    if (!script) return tl::unexpected(script.error());
    setup.script = std::move(*script);
  }
  setup.out = options.out;
  setup.picture = options.picture;
  setup.overwrite = options.force;
  return run_studio(setup);
}

}  // namespace

void add_paint(CLI::App& app, int& status) {
  auto options = std::make_shared<Options>();
  options->painting.backend = "auto";
  CLI::App* command =
      app.add_subcommand("paint", "the studio: a window to paint in, or to watch a session in");
  command->add_option("SESSION", options->session, "a .fude session to play");
  command->add_option("--on", options->on, "paint on the sheet as this session left it (.fude)");
  command->add_option("--script", options->script, "events to inject, as app/studio/script.h tells");
  command->add_option("--out", options->out, "record the painting as a session (.fude)");
  command->add_option("--picture", options->picture, "the sheet when the window closes (.png)");
  command->add_flag("--force", options->force, "replace existing pictures");
  options->painting.add_to(*command);
  command->callback([options, &status] {
    if (const auto done = run(*options); !done) status = report(done.error());
  });
}

}  // namespace fude
