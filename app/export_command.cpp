#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>

#include "app/commands.h"
#include "app/progress_line.h"
#include "capture/export/csv_export.h"
#include "capture/export/picture_export.h"
#include "capture/session.h"

namespace fude {
namespace {

struct Options {
  std::string session, stream, to = "csv", out, at;
  double span_ms = 100;
  bool force = false;
};

Result<std::string> read_text(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return failure(Fault::not_found, path + " cannot be read; give a table of times");
  return std::string{std::istreambuf_iterator<char>(file), {}};
}

Result<std::string> table(const Options& options, const Session& session, const SessionStream& stream) {
  if (options.at.empty()) return csv_of(session, stream);
  const auto text = read_text(options.at);
  if (!text) return tl::unexpected(text.error());
  const auto times = read_times(*text);
  if (!times) return failure(times.error().fault, options.at + ": " + times.error().message);
  const auto span =
      std::chrono::duration_cast<Duration>(std::chrono::duration<double, std::milli>(options.span_ms));
  return poses_at(session, stream, *times, span);
}

Result<void> write_table(const Options& options, const Session& session, const SessionStream& stream) {
  const auto text = table(options, session, stream);
  if (!text) return tl::unexpected(text.error());
  if (options.out.empty()) {
    std::fwrite(text->data(), 1, text->size(), stdout);
    return {};
  }
  std::ofstream file(options.out, std::ios::binary);
  file << *text;
  file.close();
  if (!file)
    return failure(Fault::storage, options.out + " cannot be written; check the folder and the disk");
  return {};
}

Result<void> write_pictures(const Options& options, const Session& session, const SessionStream& stream) {
  const ProgressLine line("exporting");
  const auto done =
      write_pictures(session, stream, options.out, options.force, [&](double share) { line.show(share); });
  if (!done) return tl::unexpected(done.error());
  const auto say = [](std::uint64_t count, const char* what) {
    if (count > 0) std::fprintf(stderr, "fude: %llu %s\n", static_cast<unsigned long long>(count), what);
  };
  say(done->absent, "pictures have left their times in the session and not their bytes");
  say(done->damaged, "pictures are damaged, and passed over");
  return {};
}

Result<void> run(const Options& options) {
  const bool pictures = options.to == "pictures";
  if (pictures && options.out.empty())
    return failure(Fault::usage, "--to pictures needs --out, the folder that they go to");
  if (pictures && !options.at.empty())
    return failure(Fault::usage, "--at gives poses, and no pictures; take --to csv");
  std::error_code ignored;
  if (!pictures && !options.out.empty() && !options.force && std::filesystem::exists(options.out, ignored))
    return failure(Fault::exists, options.out + " exists already; choose another name or give --force");
  const auto session = read_session(options.session);
  if (!session) return tl::unexpected(session.error());
  const auto stream = find_stream(*session, options.stream);
  if (!stream) return tl::unexpected(stream.error());
  return pictures ? write_pictures(options, *session, *stream) : write_table(options, *session, *stream);
}

}  // namespace

void add_export(CLI::App& app, int& status) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "export", "writes a stream of a session as a table, or a camera's pictures as files");
  command->add_option("SESSION", options->session, "a .fude session")->required();
  command->add_option("--stream", options->stream, "as `fude info` names it, or its tool or kind alone")
      ->required();
  command->add_option("--to", options->to, "the format")->check(CLI::IsMember({"csv", "pictures"}));
  command->add_option("--out", options->out,
                      "the file to write, without it the terminal; of pictures the folder");
  command->add_option("--at", options->at, "a table with host_s or t_s: gives the poses at those times");
  command
      ->add_option("--span-ms", options->span_ms,
                   "with --at: the longest time between two samples to interpolate")
      ->check(CLI::Range(0.0, 1e6));
  command->add_flag("--force", options->force, "replace existing files");
  command->callback([options, &status] {
    if (const auto done = run(*options); !done) status = report(done.error());
  });
}

}  // namespace fude
