#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "app/commands.h"
#include "app/interrupt.h"
#include "capture/sample_columns.h"
#include "drivers/transport/waker.h"
#include "rig/devices.h"
#include "rig/monitor_page.h"
#include "rig/named_device.h"

namespace fude {
namespace {

constexpr Duration between_pages = std::chrono::milliseconds(200);
constexpr const char* clear_screen = "\x1b[H\x1b[2J";

struct Options {
  std::string device;
  double seconds = 0;  // 0: until Ctrl-C
};

// The one device that is watched, heard on its reader's thread and shown on another.
class Watched {
 public:
  void appear(const DeviceDescription& device) {
    const std::lock_guard lock(mutex_);
    if (device_) return;
    device_ = device;
    meter_.emplace(device.clock);
  }
  void hear(std::size_t number, const Transfer& transfer, std::span<const Sample> samples) {
    const std::lock_guard lock(mutex_);
    if (number != 0) return;
    if (!samples.empty()) meter_->decoded_after(monotonic_now() - transfer.time);
    for (const Sample& sample : samples) {
      meter_->add(time_of(sample), after_gap(sample));
      latest_ = sample;
    }
  }
  std::string page() const {
    const std::lock_guard lock(mutex_);
    return device_ ? monitor_page(*device_, latest_, meter_->figures()) : "";
  }
  bool there() const {
    const std::lock_guard lock(mutex_);
    return device_.has_value();
  }

 private:
  mutable std::mutex mutex_;
  std::optional<DeviceDescription> device_;
  std::optional<StreamMeter> meter_;
  std::optional<Sample> latest_;
};

int monitor(const Options& options) {
  InterruptWatch interrupt;  // before any thread starts
  Watched watched;
  DevicesWish wish;
  if (auto named = named_device(options.device)) {
    wish.named.push_back(std::move(*named));
    wish.wanted = [](const AttachedDevice&) { return false; };
  } else {
    wish.wanted = [&](const AttachedDevice& found) {
      const DeviceDescription& device = found.description;
      return device.id == options.device || device.name == options.device || found.node == options.device;
    };
  }
  const auto devices = Devices::open(
      {.appeared = [&](std::size_t, const DeviceDescription& device) { watched.appear(device); },
       .heard = [&](std::size_t number, const Transfer& transfer,
                    std::span<const Sample> samples) { watched.hear(number, transfer, samples); },
       .refused = [](const Error& error) { std::fprintf(stderr, "fude: %s\n", error.message.c_str()); }},
      std::move(wish));
  if (!devices) return report(devices.error());
  if (!watched.there())
    return report({Fault::not_found, "no device '" + options.device +
                                         "' may be read here; `fude devices` lists names, ids and nodes"});
  const bool terminal = isatty(STDOUT_FILENO) != 0;
  const Timestamp start = monotonic_now();
  bool interrupted = false;
  while (!interrupted && (options.seconds <= 0 || seconds(monotonic_now() - start) < options.seconds)) {
    interrupted = interrupt.wait(between_pages);
    if (!terminal) continue;
    std::printf("%s%s", clear_screen, watched.page().c_str());
    std::fflush(stdout);
  }
  (*devices)->stop();
  if (!terminal) std::printf("%s", watched.page().c_str());
  return interrupted ? 130 : 0;
}

}  // namespace

void add_monitor(CLI::App& app, int& status) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "monitor", "shows what a device says: values, rate, jitter, tilt; into a pipe one page at the end");
  command
      ->add_option("device", options->device,
                   "its name, id or node as `fude devices` tells them, or as `fude record --add`")
      ->required();
  command->add_option("--seconds", options->seconds, "how long; without it until Ctrl-C")
      ->check(CLI::Range(0.001, 1e6));
  command->callback([options, &status] { status = monitor(*options); });
}

}  // namespace fude
