#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>
#include <memory>
#include <string>

#include "app/commands.h"
#include "capture/session.h"
#include "rig/fuse_session.h"
#include "rig/fuse_sources.h"
#include "rig/fused_table.h"

namespace fude {
namespace {

struct Options {
  std::string session, out, use;
  std::vector<double> up{0, 0, 1};
  bool smooth = false, force = false;
};

// What went wrong with single samples, where anything did.
void tell(const FusedSession& fused) {
  const auto say = [](std::uint64_t count, const char* what) {
    if (count > 0) std::fprintf(stderr, "fude: %llu %s\n", static_cast<unsigned long long>(count), what);
  };
  say(fused.counts.unsound, "samples were not numbers, and passed over");
  say(fused.counts.repeated, "inertial samples were not later than the one before, and passed over");
  say(fused.counts.outliers, "fixes were outliers, and passed over");
  say(fused.unplaced_pulses, "pulses came of an ultrasonic emitter that emitter_m does not place");
  say(fused.lateness.too_late, "samples came too late to be used");
  say(fused.lateness.restarts, "times all clocks began again, and the fusion with them");
  say(fused.lateness.rejoined,
      "times the clock of one source stepped back, and was put back beside the others'");
}

Result<void> run(const Options& options) {
  FuseWish wish{.smooth = options.smooth};
  wish.up = Eigen::Vector3d(options.up[0], options.up[1], options.up[2]);
  if (!(wish.up.norm() > 1e-6)) return failure(Fault::usage, "--up is no direction");
  if (!options.use.empty()) {
    const auto use = fuse_sources(options.use);
    if (!use) return tl::unexpected(use.error());
    wish.use = *use;
  }
  std::error_code ignored;
  if (!options.force && std::filesystem::exists(options.out, ignored))
    return failure(Fault::exists, options.out + " exists already; choose another name or give --force");
  const auto session = read_session(options.session);
  if (!session) return tl::unexpected(session.error());
  const auto fused = fuse_session(*session, wish);
  if (!fused) return tl::unexpected(fused.error());
  std::ofstream file(options.out, std::ios::binary);
  file << csv_of(*fused);
  file.close();
  if (!file)
    return failure(Fault::storage, options.out + " cannot be written; check the folder and the disk");
  tell(*fused);
  return {};
}

}  // namespace

void add_fuse(CLI::App& app, int& status) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("fuse", "the fused pose of a session, with its uncertainty, as a table");
  command->add_option("SESSION", options->session, "a .fude session")->required();
  command->add_option("--out", options->out, "the table to write")->required();
  command->add_option(
      "--use", options->use,
      "imu, gyro, accel, mag, pose, position, range, contact, opt_pose, opt_position, with a comma "
      "between them; without it all but the optical truth");
  command->add_option("--up", options->up, "the direction of up in the tracker's frame")
      ->expected(3)
      ->delimiter(',');
  command->add_flag("--smooth", options->smooth, "from the samples after each moment too: for the archive");
  command->add_flag("--force", options->force, "replace an existing file");
  command->callback([options, &status] {
    if (const auto done = run(*options); !done) status = report(done.error());
  });
}

}  // namespace fude
