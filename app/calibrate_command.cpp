#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/commands.h"
#include "app/progress_line.h"
#include "rig/calibrate_session.h"

namespace fude {
namespace {

struct Options {
  CalibrationWish wish;
  std::vector<double> tip_mm;
  std::string spin, out, report;
  std::string board = "chessboard";
  double square_mm = 25;
  double marker_mm = 0;  // 0: three quarters of a square
  bool force = false, json = false;
};

nlohmann::ordered_json as_json(const FieldValue& value) {
  return std::visit([](const auto& v) { return nlohmann::ordered_json(v); }, value);
}

nlohmann::ordered_json as_json(const Fields& fields) {
  nlohmann::ordered_json object = nlohmann::ordered_json::object();
  for (const Field& field : fields) object[field.key] = as_json(field.value);
  return object;
}

template <class T>
nlohmann::ordered_json or_null(const std::optional<T>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json();
}

nlohmann::ordered_json as_json(const CalibrationOutcome& outcome) {
  const CalibrationReport& r = outcome.report;
  return {{"procedure", r.procedure},
          {"accepted", r.accepted},
          {"reason", r.reason},
          {"unit", r.unit},
          {"rms", r.rms},
          {"rms_per_coordinate", r.rms_per_coordinate},
          {"p95", r.p95},
          {"max", r.max},
          {"held_out_rms", or_null(r.held_out_rms)},
          {"n", r.n},
          {"ci95", or_null(r.ci95)},
          {"condition", or_null(r.condition)},
          {"warnings", r.warnings},
          {"to_frame", r.to_frame},
          {"from_frame", r.from_frame},
          {"date", r.date},
          {"devices", r.devices},
          {"session", r.session},
          {"result", outcome.result ? as_json(*outcome.result) : nlohmann::ordered_json()},
          {"details", as_json(r.details)}};
}

std::string text_of(const nlohmann::ordered_json& json) {
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

Result<void> may_write(const std::string& file, bool force) {
  std::error_code ignored;
  if (!file.empty() && !force && std::filesystem::exists(file, ignored))
    return failure(Fault::exists, file + " exists already; choose another name or give --force");
  return {};
}

Result<void> write(const std::string& name, const std::string& text) {
  if (name.empty()) return {};
  std::ofstream file(name, std::ios::binary);
  file << text;
  file.close();
  if (!file) return failure(Fault::storage, name + " cannot be written; check the folder and the disk");
  return {};
}

void print(const CalibrationReport& r) {
  std::printf("%s: %s; rms %.3f %s, 95 in 100 within %.3f, worst %.3f, %zu samples\n", r.procedure.c_str(),
              r.reason.c_str(), r.rms, r.unit.c_str(), r.p95, r.max, r.n);
  for (const std::string& warning : r.warnings) std::printf("  warning: %s\n", warning.c_str());
}

// A calibration that could not even begin leaves a report too: whoever reads it finds why.
Result<void> run(Options& options) {
  for (const std::string& file : {options.out, options.report})
    if (auto free = may_write(file, options.force); !free) return free;
  if (!options.spin.empty()) options.wish.spin = options.spin;
  Board& board = options.wish.board;
  board.kind = options.board == "charuco" ? BoardKind::charuco : BoardKind::chessboard;
  board.square_m = 1e-3 * options.square_mm;
  board.marker_m = options.marker_mm > 0 ? 1e-3 * options.marker_mm : 0.75 * board.square_m;
  if (!options.tip_mm.empty()) options.wish.tip_m = 1e-3 * Eigen::Vector3d(options.tip_mm.data());
  auto outcome = [&] {
    const ProgressLine line("calibrating");
    return calibrate_session(options.wish, [&](const Progress& p) { line.show(p.covered); });
  }();
  std::optional<Error> wrong;
  if (!outcome) {
    wrong = outcome.error();
    outcome.emplace();
    outcome->report.procedure = options.wish.procedure;
    outcome->report.reason = wrong->message;
  } else if (!outcome->result) {
    wrong = Error{Fault::malformed, "refused: " + outcome->report.reason};
  }
  const auto json = text_of(as_json(*outcome));
  if (auto r = write(options.report, json); !r) return r;
  if (options.json) std::fputs(json.c_str(), stdout);
  if (wrong) return tl::unexpected(*wrong);
  if (auto r = write(options.out, toml_of({*outcome->result, outcome->report})); !r) return r;
  if (!options.json) print(outcome->report);
  return {};
}

}  // namespace

void add_calibrate(CLI::App& app, int& status) {
  auto options = std::make_shared<Options>();
  CalibrationWish& wish = options->wish;
  CLI::App* command =
      app.add_subcommand("calibrate", "finds where the brush and the paper are, and how sure that is");
  std::vector<std::string> names(calibration_procedures().begin(), calibration_procedures().end());
  command->add_option("WHAT", wish.procedure, "what to find")->required()->check(CLI::IsMember(names));
  command->add_option("SESSION", wish.session, "a .fude session of the motions that show it");
  command->add_option("--tool", wish.tool, "the tool of the tracker, where it has several");
  command->add_option("--reference", wish.reference, "the tool that stands for the tracker's frame");
  command->add_option("--cal", wish.earlier, "an earlier calibration (may be given several times)")
      ->take_all()
      ->expected(1);
  command->add_option("--tip-mm", options->tip_mm, "x,y,z of the tip in the tool's frame, instead of a pivot")
      ->delimiter(',')
      ->expected(3);
  command->add_option("--spin", options->spin, "pivot: a session in which the handle is spun about itself");
  command->add_option("--landmarks", wish.landmarks,
                      "tracker: a list of name,x,y,z in mm of the reference, touched in its order");
  command->add_option("--measured", wish.measured,
                      "tracker: the same points as the tracker has them, in mm, instead of touches");
  command->add_flag("--corners", wish.corners_first,
                    "surface: the first four touches are the paper's corners, lower left first, "
                    "counter-clockwise");
  command->add_option("--board", options->board, "camera: what it saw")
      ->check(CLI::IsMember({"chessboard", "charuco"}));
  command->add_option("--columns", wish.board.columns, "inner corners of a chessboard, squares of a ChArUco");
  command->add_option("--rows", wish.board.rows, "likewise");
  command->add_option("--square-mm", options->square_mm, "the side of a square, as printed");
  command->add_option("--marker-mm", options->marker_mm,
                      "the side of a ChArUco's marker; 0: three quarters of a square");
  command->add_option("--dictionary", wish.board.dictionary, "of a ChArUco's markers, as OpenCV names it");
  command->add_option("--out", options->out, "the calibration to write (TOML)");
  command->add_option("--report", options->report, "the report to write (JSON), also where it is refused");
  command->add_flag("--json", options->json, "the report on the terminal");
  command->add_flag("--force", options->force, "replace existing files");
  command->callback([options, &status] {
    if (const auto done = run(*options); !done) status = report(done.error());
  });
}

}  // namespace fude
