#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/commands.h"
#include "rig/import_session.h"

namespace fude {
namespace {

void print(const ImportedStream& s) {
  const auto n = [](std::uint64_t value) { return static_cast<unsigned long long>(value); };
  const char* name = s.device.empty() ? "?" : s.device.c_str();
  if (s.raw_only)
    std::printf("%s: %llu events in %llu frames kept raw (%s)\n", name, n(s.events), n(s.frames),
                s.device.empty() ? "no description of the device: give --device" : "no driver reads them");
  else if (s.pen)
    std::printf("%s: %llu events, %llu samples, %llu strokes, %llu lost, %llu out of range\n", name,
                n(s.events), n(s.samples), n(s.strokes), n(s.lost), n(s.out_of_range));
  else
    std::printf("%s: %llu events, %llu samples, %llu lost\n", name, n(s.events), n(s.samples), n(s.lost));
  for (const auto& [what, count] : s.passed_over)
    std::printf("  not understood: %llu %s\n", n(count), what.c_str());
}

}  // namespace

void add_import(CLI::App& app, int& status) {
  struct Options {
    std::string file, out, device, from = "auto", unit = "mm";
    std::optional<double> mm_per_pixel, rate_hz;
    bool force = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("import", "makes a session of someone else's recording");
  command
      ->add_option("FILE", options->file,
                   "the recording, packed with gzip or not; of pictures a folder or a pattern")
      ->required();
  std::vector<std::string> formats = import_format_names();
  formats.insert(formats.begin(), "auto");
  command->add_option("--from", options->from, "its format; auto recognises each by its content")
      ->check(CLI::IsMember(formats));
  command->add_option("--out", options->out, "the session to write (.fude)")->required();
  command->add_option("--device", options->device, "an evemu description of the device");
  command->add_option("--mm-per-pixel,--mm-per-px", options->mm_per_pixel,
                      "of mypaint-events (0.1 without it) and wacom-ink-csv (25.4/96)");
  command->add_option("--rate-hz", options->rate_hz,
                      "of poses-csv and imu-csv without t_s, and of images (1)");
  command->add_option("--unit", options->unit, "of the positions in poses-csv")
      ->check(CLI::IsMember({"m", "mm"}));
  command->add_flag("--force", options->force, "replace an existing session");
  command->callback([options, &status] {
    ImportWish wish;
    wish.options.format = import_format(options->from);
    if (!options->device.empty()) wish.options.device = options->device;
    if (options->mm_per_pixel) wish.options.per_pixel = Millimetres(*options->mm_per_pixel);
    wish.options.rate_hz = options->rate_hz;
    wish.options.metres_per_unit = options->unit == "m" ? 1 : 1e-3;
    wish.overwrite = options->force;
    const auto receipt = import_session(options->file, options->out, wish);
    if (!receipt) {
      status = report(receipt.error());
      return;
    }
    for (const ImportedStream& s : receipt->streams) print(s);
  });
}

}  // namespace fude
