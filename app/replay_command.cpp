#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "app/commands.h"
#include "app/painting_options.h"
#include "app/progress_line.h"
#include "app/report_json.h"
#include "sim/optics/png_file.h"

namespace fude {
namespace {

struct Options {
  PaintingOptions painting;
  std::string session, out, report_file, forces_file;
  int depth = 16;
  bool force = false;
};

Result<void> write_report(const std::string& path, const ReplayReport& report) {
  std::ofstream file(path);
  file << as_json(report).dump(2) << '\n';
  file.close();
  if (!file) return failure(Fault::storage, path + " cannot be written; check the folder and the disk");
  return {};
}

Result<void> write_forces(const std::string& path, const std::vector<SolvedForce>& forces) {
  std::ofstream file(path);
  file << "time_ns,end,force_x_n,force_y_n,force_z_n,torque_x_nmm,torque_y_nmm,torque_z_nmm\n";
  for (const SolvedForce& f : forces) {
    file << f.time.time_since_epoch().count() << ',' << (f.end == PenEnd::tip ? "tip" : "rubber");
    for (const Eigen::Vector3d& v : {f.on_hand.force_n, f.on_hand.torque_nmm})
      for (const double component : v) file << ',' << component;
    file << '\n';
  }
  file.close();
  if (!file) return failure(Fault::storage, path + " cannot be written; check the folder and the disk");
  return {};
}

Result<void> check_target(const std::string& path, bool force) {
  std::error_code ignored;
  if (!path.empty() && !force && std::filesystem::exists(path, ignored))
    return failure(Fault::exists, path + " exists already; choose another name or give --force");
  return {};
}

Result<void> run(const Options& options) {
  // Before the work, not after it.
  for (const std::string& path : {options.out, options.report_file, options.forces_file})
    if (auto r = check_target(path, options.force); !r) return r;
  const auto session = read_session(options.session);
  if (!session) return tl::unexpected(session.error());
  const auto settings = options.painting.settings(session->settings);
  if (!settings) return tl::unexpected(settings.error());

  auto replayed = [&] {
    const ProgressLine line("painting");
    return replay(*session, *settings, [&](double share) { line.show(share); });
  }();
  if (!replayed) return tl::unexpected(replayed.error());
  const PngOptions png{.depth = options.depth, .overwrite = options.force};
  if (auto r = write_png(options.out, replayed->picture, png); !r) return r;
  if (!options.forces_file.empty())
    if (auto r = write_forces(options.forces_file, replayed->forces); !r) return r;
  if (!options.report_file.empty()) return write_report(options.report_file, replayed->report);
  return {};
}

}  // namespace

void add_replay(CLI::App& app, int& status) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("replay", "paints a session into a picture");
  command->add_option("SESSION", options->session, "a .fude session")->required();
  command->add_option("--out", options->out, "the picture to write (.png)")->required();
  command->add_option("--depth", options->depth, "bits a channel")->check(CLI::IsMember({8, 16}));
  command->add_option("--report", options->report_file, "figures of the replay (.json)");
  command->add_option("--forces", options->forces_file, "force and torque of the brush on the hand (.csv)");
  command->add_flag("--force", options->force, "replace existing files");
  options->painting.add_to(*command);
  command->callback([options, &status] {
    if (const auto done = run(*options); !done) status = report(done.error());
  });
}

}  // namespace fude
