#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>

#include "app/commands.h"
#include "rig/import_session.h"

namespace fude {

void add_import(CLI::App& app, int& status) {
  struct Options {
    std::string file, out, device, from = "auto";
    double mm_per_pixel = default_mm_per_pixel.value;
    bool force = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("import", "makes a session of someone else's recording");
  command->add_option("FILE", options->file, "the recording")->required();
  command->add_option("--from", options->from, "its format")
      ->check(CLI::IsMember({"auto", "evemu", "libinput", "mypaint-events"}));
  command->add_option("--out", options->out, "the session to write (.fude)")->required();
  command->add_option("--device", options->device, "an evemu description of the device");
  command->add_option("--mm-per-pixel", options->mm_per_pixel, "for mypaint-events");
  command->add_flag("--force", options->force, "replace an existing session");
  command->callback([options, &status] {
    ImportWish wish;
    wish.options.format = import_format(options->from);
    if (!options->device.empty()) wish.options.device = options->device;
    wish.options.per_pixel = Millimetres(options->mm_per_pixel);
    wish.overwrite = options->force;
    const auto receipt = import_session(options->file, options->out, wish);
    if (!receipt) {
      status = report(receipt.error());
      return;
    }
    for (const ImportedStream& s : receipt->streams) {
      const auto n = [](std::uint64_t value) { return static_cast<unsigned long long>(value); };
      if (s.raw_only)
        std::printf("%s: %llu events in %llu frames kept raw (%s)\n",
                    s.device.empty() ? "?" : s.device.c_str(), n(s.events), n(s.frames),
                    s.device.empty() ? "no description of the device: give --device" : "not a pen");
      else
        std::printf("%s: %llu events, %llu samples, %llu strokes, %llu lost, %llu out of range\n",
                    s.device.c_str(), n(s.events), n(s.samples), n(s.strokes), n(s.lost), n(s.out_of_range));
    }
  });
}

}  // namespace fude
