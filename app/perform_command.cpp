#include <CLI/CLI.hpp>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>

#include "app/commands.h"
#include "rig/performance.h"
#include "rig/share_folder.h"

namespace fude {
namespace {

Result<Performance> load(const std::string& name) {
  const auto file = find_shared("performances", name, ".toml");
  if (!file) return tl::unexpected(file.error());
  std::ifstream in(*file, std::ios::binary);
  const std::string text((std::istreambuf_iterator<char>(in)), {});
  return read_performance(text, file->string());
}

}  // namespace

void add_perform(CLI::App& app, int& status) {
  struct Options {
    std::string script, out;
    bool force = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("perform", "plays a scripted performance into a session");
  command->add_option("SCRIPT", options->script, "a performance of share/performances, or a TOML file")
      ->required();
  command->add_option("--out", options->out, "the session to write (.fude)")->required();
  command->add_flag("--force", options->force, "replace an existing session");
  command->callback([options, &status] {
    const auto performance = load(options->script);
    const auto done = performance ? write_performance(*performance, options->out, options->force)
                                  : Result<void>(tl::unexpected(performance.error()));
    if (!done) status = report(done.error());
  });
}

}  // namespace fude
