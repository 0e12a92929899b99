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
#include "rig/attached_devices.h"

namespace fude {
namespace {

const char* kind_words(DeviceKind kind) {
  switch (kind) {
    case DeviceKind::pen_tablet:
      return "pen tablet";
    case DeviceKind::touch:
      return "touch surface";
    case DeviceKind::tracker:
      return "6-DOF tracker";
    case DeviceKind::imu:
      return "inertial unit";
    case DeviceKind::ultrasonic:
      return "ultrasonic receiver";
    case DeviceKind::puck:
      return "6-axis controller";
    case DeviceKind::glove:
      return "glove";
    case DeviceKind::haptic:
      return "force-feedback arm";
    case DeviceKind::camera:
      return "camera";
    default:
      return "other";
  }
}

std::vector<std::string> senses(const DeviceDescription& device) {
  switch (device.kind) {
    case DeviceKind::pen_tablet:
    case DeviceKind::touch:
      return capabilities(device);
    case DeviceKind::tracker:
      return {"position", "orientation"};
    case DeviceKind::imu:
      return {"turn-rate", "acceleration", "buttons"};
    case DeviceKind::ultrasonic:
      return {"ranges"};
    case DeviceKind::puck:
      return {"push", "turn", "buttons"};
    case DeviceKind::glove:
      return {"bend", "lights", "buttons"};
    case DeviceKind::haptic:
      return {"position", "force", "buttons"};
    case DeviceKind::camera:
      return {"pictures"};
    default:
      return {};
  }
}

std::string four_digits(std::uint16_t number) {
  char text[8];
  std::snprintf(text, sizeof text, "%04x", unsigned{number});
  return text;
}

nlohmann::ordered_json as_json(const AttachedDevice& found) {
  const DeviceDescription& device = found.description;
  return {{"id", device.id},
          {"name", device.name},
          {"kind", kind_words(device.kind)},
          {"driver", found.family->word},
          {"transport", device.transport},
          {"node", found.node.string()},
          {"vendor", four_digits(device.vendor)},
          {"product", four_digits(device.product)},
          {"serial", device.serial},
          {"capabilities", senses(device)},
          {"rate_hz", found.rate_hz ? nlohmann::ordered_json(*found.rate_hz) : nlohmann::ordered_json()},
          {"access", found.access}};
}

std::string text_of(const nlohmann::ordered_json& json, int indent) {
  return json.dump(indent, ' ', false, nlohmann::json::error_handler_t::replace);
}

void print(const AttachedDevice& found) {
  std::string words;
  for (const std::string& word : senses(found.description)) words += " " + word;
  std::printf("%s  %s  %s  %s, senses%s\n", found.node.c_str(), found.description.id.c_str(),
              found.description.name.c_str(), kind_words(found.description.kind), words.c_str());
  if (!found.access) std::printf("  %s\n", access_advice(found.node).c_str());
}

// Tells of devices that come, and of the nodes of devices that go.
class Telling {
 public:
  Telling(std::vector<AttachedDevice> known, bool json) : known_(std::move(known)), json_(json) {}

  void plugged(const std::optional<AttachedDevice>& device) {
    if (!device || find(device->node) != known_.end()) return;
    if (json_)
      tell({{"event", "plugged"}, {"node", device->node.string()}, {"device", as_json(*device)}});
    else
      std::printf("plugged in: "), print(*device), std::fflush(stdout);
    known_.push_back(*device);
  }
  void unplugged(const std::filesystem::path& node) {
    const auto at = find(node);
    if (at == known_.end()) return;
    if (json_)
      tell({{"event", "unplugged"}, {"node", node.string()}});
    else
      std::printf("unplugged: %s\n", node.c_str()), std::fflush(stdout);
    known_.erase(at);
  }

 private:
  std::vector<AttachedDevice>::iterator find(const std::filesystem::path& node) {
    return std::ranges::find(known_, node, &AttachedDevice::node);
  }
  static void tell(const nlohmann::ordered_json& line) {
    std::printf("%s\n", text_of(line, -1).c_str());
    std::fflush(stdout);
  }

  std::vector<AttachedDevice> known_;
  bool json_;
};

// Until Ctrl-C.
int watch(NodeMonitor& monitor, Telling& telling, InterruptWatch& interrupt) {
  std::atomic<bool> ended{false};
  std::thread watching([&] {
    while (!ended)
      if (const auto event = monitor.next(std::nullopt)) {
        if (event->plugged)
          telling.plugged(attached(event->node));
        else
          telling.unplugged(event->node.path);
      }
  });
  interrupt.wait(std::nullopt);
  ended = true;
  monitor.wake();
  watching.join();
  return 130;
}

void print_all(const std::vector<AttachedDevice>& devices, bool json, int indent) {
  if (json) {
    nlohmann::ordered_json all = nlohmann::ordered_json::array();
    for (const AttachedDevice& device : devices) all.push_back(as_json(device));
    std::printf("%s\n", text_of(all, indent).c_str());
  } else {
    for (const AttachedDevice& device : devices) print(device);
    if (devices.empty()) std::printf("no device that fude knows is plugged in\n");
  }
  std::fflush(stdout);
}

int list(bool json) {
  const auto found = attached_devices();
  if (!found) return report(found.error());
  print_all(*found, json, 2);
  return 0;
}

int list_and_watch(bool json) {
  InterruptWatch interrupt;  // before any thread starts
  // The monitor first, so that nothing plugged in meanwhile is missed.
  auto monitor = NodeMonitor::open(all_node_kinds);
  if (!monitor) return report(monitor.error());
  const auto found = attached_devices();
  if (!found) return report(found.error());
  print_all(*found, json, -1);
  Telling telling(*found, json);
  return watch(**monitor, telling, interrupt);
}

}  // namespace

void add_devices(CLI::App& app, int& status) {
  struct Options {
    bool json = false;
    bool watch = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("devices", "lists the devices that are plugged in");
  command->add_flag("--json", options->json, "as JSON; with --watch one line an event");
  command->add_flag("--watch", options->watch, "follow plugging in and out until Ctrl-C");
  command->callback(
      [options, &status] { status = options->watch ? list_and_watch(options->json) : list(options->json); });
}

}  // namespace fude
