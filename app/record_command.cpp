#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>

#include "app/commands.h"
#include "app/interrupt.h"
#include "rig/record_session.h"

namespace fude {
namespace {

struct Options {
  std::string out;
  double seconds = 0;  // 0: until Ctrl-C
  bool force = false;
};

int record(const Options& options) {
  InterruptWatch interrupt;  // before any thread starts
  auto recording = RecordingSession::start(options.out, options.force, [](const std::string& warning) {
    std::fprintf(stderr, "fude: %s\n", warning.c_str());
  });
  if (!recording) return report(recording.error());
  std::fprintf(stderr, "recording into %s; Ctrl-C ends it\n", options.out.c_str());
  const auto limit = options.seconds > 0 ? std::optional(std::chrono::duration_cast<Duration>(
                                               std::chrono::duration<double>(options.seconds)))
                                         : std::nullopt;
  const bool interrupted = interrupt.wait(limit);
  const auto streams = (*recording)->finish();
  if (!streams) return report(streams.error());
  for (const RecordedStream& stream : *streams)
    std::printf("%s: expected %lld, received %lld, dropped %lld\n", stream.device.c_str(),
                static_cast<long long>(stream.expected), static_cast<long long>(stream.received),
                static_cast<long long>(stream.dropped));
  return interrupted ? 130 : 0;
}

}  // namespace

void add_record(CLI::App& app, int& status) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("record", "records the tablets that are plugged in");
  command->add_option("--out", options->out, "the session to write (.fude)")->required();
  command->add_option("--seconds", options->seconds, "how long; without it until Ctrl-C")
      ->check(CLI::Range(0.001, 1e6));
  command->add_flag("--force", options->force, "replace an existing session");
  command->callback([options, &status] { status = record(*options); });
}

}  // namespace fude
