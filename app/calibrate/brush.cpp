// The twin of a real brush, for `fude replay --brush` and all that takes one.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>

#include "app/calibrate/outcome_json.h"
#include "app/calibrate/procedures.h"
#include "app/calibrate/written_file.h"
#include "app/commands.h"
#include "app/progress_line.h"
#include "rig/calibration/brush_twin.h"
#include "rig/calibration/twin_trials.h"
#include "rig/share_folder.h"

namespace fude {
namespace {

struct Options {
  std::string folder, brush = "round-goat", out, report;
  int starts = 2;
  bool json = false, force = false;
};

Result<BrushTwin> find(const Options& options) {
  const auto path = find_shared("brushes", options.brush, ".toml");
  if (!path) return tl::unexpected(path.error());
  const auto known = read_brush_spec(path->string());
  if (!known) return tl::unexpected(known.error());
  const auto trials = read_twin_trials(options.folder);
  if (!trials) return tl::unexpected(trials.error());
  const ProgressLine line("fitting");
  return twin_of(*known, *trials, options.starts, [&](double share) { line.show(share); });
}

Result<void> run(const Options& options) {
  for (const std::string& file : {options.out, options.report})
    if (auto free = may_write(file, options.force); !free) return free;
  auto twin = find(options);
  std::optional<Error> wrong;
  if (!twin) {
    wrong = twin.error();
    twin.emplace();
    twin->outcome.report.procedure = "brush";
    twin->outcome.report.reason = wrong->message;
  } else if (!twin->outcome.result) {
    wrong = Error{Fault::malformed, "refused: " + twin->outcome.report.reason};
  }
  const CalibrationReport& r = twin->outcome.report;
  const std::string json = json_of(twin->outcome);
  if (auto written = write_file(options.report, json); !written) return written;
  if (options.json) std::fputs(json.c_str(), stdout);
  if (wrong) return tl::unexpected(*wrong);
  const std::string remark =
      "The twin of a real brush, from " + std::to_string(r.n) + " footprints: " + r.reason + ".";
  if (auto written = write_file(options.out, toml_of(twin->spec, remark)); !written) return written;
  if (options.json) return {};
  std::printf("brush: %s\n", r.reason.c_str());
  for (const std::string& warning : r.warnings) std::printf("  warning: %s\n", warning.c_str());
  return {};
}

}  // namespace

void add_calibrate_brush(CLI::App& calibrate, int& status) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      calibrate.add_subcommand("brush", "the twin of a real brush, from footprints that it left");
  command->add_option("FOLDER", options->folder, "pictures of footprints, the poses of each, and trials.toml")
      ->required();
  command->add_option("--brush", options->brush,
                      "the brush with its lengths and radii: of share/brushes, or a TOML file");
  command->add_option("--starts", options->starts, "places that the search begins at")
      ->check(CLI::Range(1, 8));
  command->add_option("--out", options->out, "the brush to write (TOML)");
  command->add_option("--report", options->report, "the report to write (JSON), also where it is refused");
  command->add_flag("--json", options->json, "the report on the terminal");
  command->add_flag("--force", options->force, "replace existing files");
  command->callback([options, &status] {
    if (const auto done = run(*options); !done) status = report(done.error());
  });
}

}  // namespace fude
