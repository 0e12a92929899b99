#include "app/calibrate/procedure_command.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <utility>
#include <vector>

#include "app/calibrate/outcome_json.h"
#include "app/calibrate/written_file.h"
#include "app/commands.h"
#include "app/enter_key.h"
#include "app/interrupt.h"
#include "app/numbers_option.h"
#include "app/progress_line.h"
#include "rig/calibration/calibrate_session.h"
#include "rig/calibration/calibration_store.h"
#include "rig/calibration/live_calibration.h"
#include "rig/calibration/undistortion.h"
#include "rig/named_device.h"

namespace fude {
namespace {

constexpr Duration between_looks = std::chrono::milliseconds(100);

struct Options {
  std::filesystem::path session;
  std::vector<std::filesystem::path> earlier;
  std::vector<std::string> named;
  std::string out, report;
  bool live = false, no_keep = false, force = false, json = false;
};

void tell(const std::string& what) { std::fprintf(stderr, "fude: %s\n", what.c_str()); }

std::vector<StoredCalibration> kept() {
  std::vector<std::string> warnings;
  auto calibrations = calibrations_of_user(warnings);
  for (const std::string& warning : warnings) tell(warning);
  return calibrations;
}

Result<KnownCalibrations> known_beside(const Options& options) {
  auto known = KnownCalibrations::read(options.earlier);
  if (known) known->keep(kept());
  return known;
}

Result<std::unique_ptr<Calibrator>> calibrator_of(const Procedure& procedure, KnownCalibrations known) {
  if (!procedure.undistorted) return procedure.make(std::move(known));
  auto calibrator = procedure.make(known);
  if (!calibrator) return calibrator;
  return undistorted(std::move(*calibrator), std::move(known));
}

Result<CalibrationOutcome> hear_session(const Procedure& procedure, const Options& options) {
  const bool needs_session = !procedure.needs_session || procedure.needs_session();
  if (needs_session && options.session.empty())
    return failure(Fault::usage, "give the session of the motions: fude calibrate " + procedure.name +
                                     " SESSION; or --live, to hear the devices");
  auto known = known_beside(options);
  if (!known) return tl::unexpected(known.error());
  const auto session = options.session.empty() ? Result<Session>(Session{}) : read_session(options.session);
  if (!session) return tl::unexpected(session.error());
  known->carry(*session);
  const auto calibrator = calibrator_of(procedure, std::move(*known));
  if (!calibrator) return tl::unexpected(calibrator.error());
  const ProgressLine line("calibrating");
  return calibrate_session(**calibrator, *session,
                           [&](const Progress& p) { line.show(p.covered, p.missing); });
}

// Until Ctrl-C or Enter, or until nothing is missing or it cannot go on.
void attend(InterruptWatch& interrupt, const LiveCalibration& live) {
  EnterKey enter;
  const ProgressLine line("calibrating");
  for (;;) {
    const auto progress = live.progress();
    if (!progress || progress->covered >= 1) return;
    line.show(progress->covered, progress->missing);
    if (interrupt.wait(between_looks) || enter.pressed()) return;
  }
}

Result<CalibrationOutcome> hear_devices(const Procedure& procedure, const Options& options) {
  InterruptWatch interrupt;  // before any thread starts
  LiveWish wish{.overwrite = options.force, .calibrations = kept()};
  if (!options.session.empty()) wish.session = options.session;
  for (const std::string& name : options.named) {
    auto device = named_device(name);
    if (!device) return tl::unexpected(device.error());
    wish.named.push_back(std::move(*device));
  }
  auto known = known_beside(options);
  if (!known) return tl::unexpected(known.error());
  const auto calibrator = calibrator_of(procedure, std::move(*known));
  if (!calibrator) return tl::unexpected(calibrator.error());
  const auto live = LiveCalibration::start(**calibrator, std::move(wish), tell);
  if (!live) return tl::unexpected(live.error());
  tell("hearing the devices; Enter or Ctrl-C ends it");
  attend(interrupt, **live);
  return (*live)->finish();
}

void print(const CalibrationReport& r) {
  std::printf("%s: %s; rms %.3f %s, 95 in 100 within %.3f, worst %.3f, %zu samples\n", r.procedure.c_str(),
              r.reason.c_str(), r.rms, r.unit.c_str(), r.p95, r.max, r.n);
  for (const std::string& warning : r.warnings) std::printf("  warning: %s\n", warning.c_str());
}

// What cannot be kept is still written where the user asked for it.
void keep(const StoredCalibration& calibration, const Options& options) {
  if (options.no_keep || calibration.report.devices.empty()) return;
  const auto store = CalibrationStore::of_user();
  const auto version = store ? store->keep(calibration) : tl::unexpected(store.error());
  if (!version)
    tell("not kept: " + version.error().message);
  else if (!options.json)
    std::printf("  kept as version %d\n", version->version);
}

// A calibration that could not even begin leaves a report too: whoever reads it finds why.
Result<void> run(const Procedure& procedure, const Options& options) {
  for (const std::string& file : {options.out, options.report})
    if (auto free = may_write(file, options.force); !free) return free;
  auto outcome = options.live ? hear_devices(procedure, options) : hear_session(procedure, options);
  std::optional<Error> wrong;
  if (!outcome) {
    wrong = outcome.error();
    outcome.emplace();
    outcome->report.procedure = procedure.name;
    outcome->report.reason = wrong->message;
  } else if (!outcome->result) {
    wrong = Error{Fault::malformed, "refused: " + outcome->report.reason};
  }
  const std::string json = json_of(*outcome);
  if (auto r = write_file(options.report, json); !r) return r;
  if (options.json) std::fputs(json.c_str(), stdout);
  if (wrong) return tl::unexpected(*wrong);
  const StoredCalibration calibration{*outcome->result, outcome->report};
  if (auto r = write_file(options.out, toml_of(calibration)); !r) return r;
  if (!options.json) print(outcome->report);
  if (procedure.kept) keep(calibration, options);
  return {};
}

}  // namespace

CLI::App* add_procedure(CLI::App& calibrate, int& status, Procedure procedure) {
  auto options = std::make_shared<Options>();
  CLI::App* command = calibrate.add_subcommand(procedure.name, procedure.finds);
  command->add_option("SESSION", options->session,
                      "a .fude session of the motions that show it; with --live, where to keep them");
  command->add_flag("--live", options->live, "hear the devices that are plugged in");
  command->add_option("--add", options->named,
                      "with --live: a device that is not found by itself, as `fude record --add`");
  command->add_option("--cal", options->earlier, "an earlier calibration (may be given several times)")
      ->take_all()
      ->expected(1);
  command->add_option("--out", options->out, "the calibration to write (TOML)");
  command->add_option("--report", options->report, "the report to write (JSON), also where it is refused");
  command->add_flag("--no-keep", options->no_keep, "do not keep it among the calibrations of this rig");
  command->add_flag("--json", options->json, "the report on the terminal");
  command->add_flag("--force", options->force, "replace existing files");
  command->callback([procedure = std::move(procedure), options, &status] {
    if (const auto done = run(procedure, *options); !done) status = report(done.error());
  });
  return command;
}

void add_tool_options(CLI::App& command, ToolWish& wish) {
  command.add_option("--tool", wish.tool, "the tool of the tracker, where it has several");
  command.add_option("--reference", wish.reference, "the tool that stands for the tracker's frame");
}

void add_tip_option(CLI::App& command, std::optional<Eigen::Vector3d>& tip_m) {
  add_numbers_option(command, "--tip-mm", "x,y,z of the tip in the tool's frame, instead of a pivot",
                     [&tip_m](const Eigen::Vector3d& mm) { tip_m = 1e-3 * mm; });
}

}  // namespace fude
