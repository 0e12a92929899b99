#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/commands.h"
#include "app/numbers_option.h"
#include "capture/session.h"
#include "rig/fusion/fuse_session.h"
#include "rig/fusion/fuse_sources.h"
#include "rig/fusion/fused_table.h"
#include "rig/fusion/keep_fused.h"

namespace fude {
namespace {

struct Options {
  std::string session, out, into, use;
  std::optional<Eigen::Vector3d> up;  // none: by gravity
  std::vector<std::string> calibrations;
  bool smooth = false, force = false;
};

// What was applied, and what went wrong with single samples, where anything did.
void tell(const FusedSession& fused) {
  for (const std::string& note : fused.notes) std::fprintf(stderr, "fude: %s\n", note.c_str());
  const auto say = [](std::uint64_t count, const char* what) {
    if (count > 0) std::fprintf(stderr, "fude: %llu %s\n", static_cast<unsigned long long>(count), what);
  };
  say(fused.counts.unsound, "samples were no numbers or beyond what can be measured, and passed over");
  say(fused.counts.repeated, "inertial samples were not later than the one before, and passed over");
  say(fused.counts.outliers, "fixes were outliers, and passed over");
  say(fused.unplaced_pulses, "pulses came of an ultrasonic emitter that emitter_m does not place");
  say(fused.unmapped_poses, "poses lie beyond where the tracker's distortion is mapped");
  say(fused.counts.changed_mind,
      "times a source jumped and stayed where it jumped to: does its tracker flip?");
  say(fused.counts.disturbed_field,
      "times, ten a second, the magnetic field was disturbed, and not followed");
  say(fused.lateness.leaps, "samples had a time far ahead of all others, and were passed over");
  say(fused.lateness.too_late, "samples came too late to be used");
  say(fused.lateness.restarts, "times all clocks began again, and the fusion with them");
  say(fused.lateness.rejoined,
      "times the clock of one source stepped back, and was put back beside the others'");
}

Result<FuseWish> wish_of(const Options& options) {
  FuseWish wish{.smooth = options.smooth};
  if (options.up) {
    wish.up = options.up;
    if (!(wish.up->norm() > 1e-6)) return failure(Fault::usage, "--up is no direction");
  }
  if (!options.use.empty()) {
    const auto use = fuse_sources(options.use);
    if (!use) return tl::unexpected(use.error());
    wish.use = *use;
  }
  for (const std::string& name : options.calibrations) {
    std::ifstream file(name, std::ios::binary);
    if (!file) return failure(Fault::not_found, name + " cannot be read");
    wish.calibrations.push_back({name, {std::istreambuf_iterator<char>(file), {}}});
  }
  return wish;
}

Result<void> may_write(const Options& options) {
  std::error_code ignored;
  for (const std::string& file : {options.out, options.into}) {
    if (file.empty() || !std::filesystem::exists(file, ignored)) continue;
    if (std::filesystem::equivalent(file, options.session, ignored))
      return failure(Fault::usage,
                     file + " is the session itself, which stays as it is; choose another name");
    if (!options.force)
      return failure(Fault::exists, file + " exists already; choose another name or give --force");
  }
  return {};
}

// The causal poses and the smoothed ones, beside all that they are made of.
Result<void> keep(const Session& session, FuseWish wish, const FusedSession& fused, const Options& options) {
  wish.smooth = !options.smooth;
  const auto other = fuse_session(session, wish);
  if (!other) return tl::unexpected(other.error());
  return keep_fused(session, options.smooth ? FusedArchive{*other, fused} : FusedArchive{fused, *other},
                    options.into, options.force);
}

Result<void> run(const Options& options) {
  const auto wish = wish_of(options);
  if (!wish) return tl::unexpected(wish.error());
  if (auto free = may_write(options); !free) return free;
  const auto session = read_session(options.session);
  if (!session) return tl::unexpected(session.error());
  const auto fused = fuse_session(*session, *wish);
  if (!fused) return tl::unexpected(fused.error());
  tell(*fused);
  if (!options.into.empty())
    if (auto kept = keep(*session, *wish, *fused, options); !kept) return kept;
  std::ofstream file(options.out, std::ios::binary);
  file << csv_of(*fused);
  file.close();
  if (!file)
    return failure(Fault::storage, options.out + " cannot be written; check the folder and the disk");
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
  command->add_option(
      "--into", options->into,
      "a new session too: all of this one, with the causal and the smoothed poses as streams");
  command
      ->add_option("--cal", options->calibrations,
                   "a calibration beside those that the session carries (may be given several times)")
      ->take_all()
      ->expected(1);
  add_numbers_option(*command, "--up",
                     "x,y,z: the direction of up in the tracker's frame; without it as gravity has it",
                     [options = options.get()](const Eigen::Vector3d& up) { options->up = up; });
  command->add_flag("--smooth", options->smooth, "from the samples after each moment too: for the archive");
  command->add_flag("--force", options->force, "replace existing files");
  command->callback([options, &status] {
    if (const auto done = run(*options); !done) status = report(done.error());
  });
}

}  // namespace fude
