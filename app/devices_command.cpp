#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "app/commands.h"
#include "app/interrupt.h"
#include "drivers/tablet/identify.h"
#include "drivers/transport/device_node.h"
#include "drivers/transport/evdev_devices.h"

namespace fude {
namespace {

std::string four_digits(std::uint16_t number) {
  char text[8];
  std::snprintf(text, sizeof text, "%04x", unsigned{number});
  return text;
}

nlohmann::ordered_json as_json(const FoundDevice& found) {
  const DeviceDescription& device = found.description;
  return {{"id", device.id},
          {"name", device.name},
          {"kind", "pen tablet"},
          {"transport", device.transport},
          {"vendor", four_digits(device.vendor)},
          {"product", four_digits(device.product)},
          {"serial", device.serial},
          {"capabilities", capabilities(device)},
          {"rate_hz", found.rate_hz ? nlohmann::ordered_json(*found.rate_hz) : nlohmann::ordered_json()},
          {"access", found.access}};
}

std::string text_of(const nlohmann::ordered_json& json, int indent) {
  return json.dump(indent, ' ', false, nlohmann::json::error_handler_t::replace);
}

void print(const FoundDevice& found) {
  std::string senses;
  for (const std::string& word : capabilities(found.description)) senses += " " + word;
  std::printf("%s  %s  %s  senses%s\n", found.node.c_str(), found.description.id.c_str(),
              found.description.name.c_str(), senses.c_str());
  if (!found.access) std::printf("  %s\n", access_advice(found.node).c_str());
}

void print(const PlugEvent& event, bool json) {
  if (json) {
    nlohmann::ordered_json line{{"event", event.plugged ? "plugged" : "unplugged"},
                                {"node", event.node.string()}};
    if (event.tablet) line["device"] = as_json(*event.tablet);
    std::printf("%s\n", text_of(line, -1).c_str());
  } else if (event.tablet) {
    std::printf("plugged in: ");
    print(*event.tablet);
  } else {
    std::printf("unplugged: %s\n", event.node.c_str());
  }
  std::fflush(stdout);
}

// Tells of tablets that come, and of the nodes of tablets that go, until Ctrl-C.
int watch(PlugMonitor& monitor, std::vector<FoundDevice> known, bool json, InterruptWatch& interrupt) {
  std::atomic<bool> ended{false};
  std::thread watching([&] {
    while (!ended) {
      const auto event = monitor.next(std::nullopt);
      if (!event) continue;
      const auto same = [&](const FoundDevice& device) { return device.node == event->node; };
      const auto at = std::find_if(known.begin(), known.end(), same);
      if (event->plugged && event->tablet && at == known.end()) {
        print(*event, json);
        known.push_back(*event->tablet);
      } else if (!event->plugged && at != known.end()) {
        print(*event, json);
        known.erase(at);
      }
    }
  });
  interrupt.wait(std::nullopt);
  ended = true;
  monitor.wake();
  watching.join();
  return 130;
}

int list(bool json, bool watching) {
  InterruptWatch interrupt;
  // The monitor first, so that nothing plugged in meanwhile is missed.
  auto monitor = watching ? PlugMonitor::open() : Result<std::unique_ptr<PlugMonitor>>(nullptr);
  if (!monitor) return report(monitor.error());
  const auto found = find_pen_tablets();
  if (!found) return report(found.error());
  if (json) {
    nlohmann::ordered_json all = nlohmann::ordered_json::array();
    for (const FoundDevice& device : *found) all.push_back(as_json(device));
    std::printf("%s\n", text_of(all, watching ? -1 : 2).c_str());
  } else {
    for (const FoundDevice& device : *found) print(device);
    if (found->empty()) std::printf("no pen tablet is plugged in\n");
  }
  std::fflush(stdout);
  return watching ? watch(**monitor, *found, json, interrupt) : 0;
}

}  // namespace

void add_devices(CLI::App& app, int& status) {
  struct Options {
    bool json = false;
    bool watch = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("devices", "lists the pen tablets that are plugged in");
  command->add_flag("--json", options->json, "as JSON; with --watch one line an event");
  command->add_flag("--watch", options->watch, "follow plugging in and out until Ctrl-C");
  command->callback([options, &status] { status = list(options->json, options->watch); });
}

}  // namespace fude
