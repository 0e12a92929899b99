#include "rig/doctor.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fude {
namespace {

constexpr std::uintmax_t roomy = 1'000'000'000;  // an hour of a few devices without a camera takes less
constexpr std::uintmax_t least = 20'000'000;
constexpr Duration tolerated_stamp = std::chrono::seconds(2);
constexpr std::array<const char*, 3> device_groups{"input", "dialout", "video"};

std::string megabytes(std::uintmax_t bytes) { return std::to_string(bytes / 1'000'000) + " MB"; }

bool member(const Machine& machine, const std::string& group) {
  return std::find(machine.groups.begin(), machine.groups.end(), group) != machine.groups.end();
}

std::string group_of(const PluggedDevice& device) {
  if (device.camera) return "video";
  return device.node.string().starts_with("/dev/tty") ? "dialout" : "input";
}

std::string install_rule(const Machine& machine) {
  if (machine.own_rule.empty()) return "";
  return "sudo install -m 644 " + machine.own_rule.string() +
         " /etc/udev/rules.d/ && sudo udevadm control --reload && sudo udevadm trigger";
}

void diagnose_devices(const Machine& machine, std::vector<Finding>& findings) {
  if (!machine.udev)
    findings.push_back({"udev", Standing::lacking, "does not answer; only a mouse can paint here", ""});
  bool tablet = false;
  bool camera = false;
  for (const PluggedDevice& device : machine.devices) {
    tablet = tablet || device.pen_tablet;
    camera = camera || device.camera;
    Finding finding{device.name, Standing::good, device.node.string() + " may be read", ""};
    if (!device.access) {
      finding.standing = device.pen_tablet ? Standing::hinders : Standing::lacking;
      finding.says = device.node.string() + " may not be read";
      finding.command = machine.rule || install_rule(machine).empty()
                            ? "sudo usermod -aG " + group_of(device) + " $USER"
                            : install_rule(machine);
    }
    findings.push_back(finding);
  }
  if (machine.udev && !tablet)
    findings.push_back({"pen tablet", Standing::lacking, "none is plugged in; a mouse paints too", ""});
  if (machine.udev && !camera)
    findings.push_back({"camera", Standing::lacking, "none is plugged in; only a footprint needs one", ""});
}

void diagnose_access(const Machine& machine, std::vector<Finding>& findings) {
  if (machine.rule)
    findings.push_back({"udev rule", Standing::good, machine.rule->string(), ""});
  else
    findings.push_back({"udev rule", Standing::lacking, "fude's is not installed", install_rule(machine)});

  std::string missing;
  for (const char* group : device_groups)
    if (!machine.root && !member(machine, group))
      missing += (missing.empty() ? "" : ",") + std::string(group);
  if (missing.empty())
    findings.push_back(
        {"groups", Standing::good, machine.root ? "root needs none" : "input, dialout, video", ""});
  else if (machine.rule)
    findings.push_back(
        {"groups", Standing::good, "not in " + missing + "; the udev rule stands in for them", ""});
  else
    findings.push_back({"groups", Standing::lacking,
                        "not in " + missing + " (log in again after the command)",
                        "sudo usermod -aG " + missing + " $USER"});

  if (machine.uinput_writable)
    findings.push_back({"uinput", Standing::good, "/dev/uinput may be written", ""});
  else if (machine.uinput_there)
    findings.push_back({"uinput", Standing::lacking,
                        "/dev/uinput may not be written; fude play needs it for pens",
                        "sudo setfacl -m u:$USER:rw /dev/uinput"});
  else
    findings.push_back({"uinput", Standing::lacking, "there is no /dev/uinput; fude play needs it for pens",
                        "sudo modprobe uinput"});
}

void diagnose_picture(const Machine& machine, std::vector<Finding>& findings) {
  findings.push_back(machine.display
                         ? Finding{"display", Standing::good, "a window can open", ""}
                         : Finding{"display", Standing::hinders,
                                   "there is none for a window; fude replay paints without one", ""});
  if (!machine.opengl) {
    findings.push_back({"OpenGL", Standing::hinders, machine.no_opengl,
                        "sudo apt-get install libegl1 libgl1 libgl1-mesa-dri"});
    return;
  }
  const std::string what = machine.opengl->version + ", " + machine.opengl->renderer;
  if (machine.opengl->software)
    findings.push_back({"OpenGL", Standing::lacking, what + " (software: slow)", ""});
  else
    findings.push_back({"OpenGL", Standing::good, what + " (hardware)", ""});
}

void diagnose_folder(const Machine& machine, std::vector<Finding>& findings) {
  const std::string folder = machine.folder.string();
  if (!machine.folder_writable) {
    findings.push_back({"session folder", Standing::hinders, folder + " takes no files",
                        "mkdir -p '" + folder + "' && chmod u+rwx '" + folder + "'"});
    return;
  }
  const Standing room = machine.free_bytes < least   ? Standing::hinders
                        : machine.free_bytes < roomy ? Standing::lacking
                                                     : Standing::good;
  findings.push_back({"disk", room,
                      megabytes(machine.free_bytes) + " free in " + folder +
                          (room == Standing::good ? "" : "; make room, or choose another folder"),
                      ""});
  if (!machine.stamp_ahead) return;
  const double ahead_s = seconds(*machine.stamp_ahead);
  if (std::chrono::abs(*machine.stamp_ahead) <= tolerated_stamp)
    findings.push_back({"clock", Standing::good, "the folder's is the machine's", ""});
  else
    findings.push_back({"clock", Standing::lacking,
                        "files in " + folder + " are stamped " +
                            std::to_string(std::llround(std::abs(ahead_s))) + " s " +
                            (ahead_s > 0 ? "ahead of" : "behind") + " this machine's clock",
                        "sudo timedatectl set-ntp true"});
}

}  // namespace

std::vector<Finding> diagnose(const Machine& machine) {
  std::vector<Finding> findings;
  diagnose_devices(machine, findings);
  diagnose_access(machine, findings);
  diagnose_picture(machine, findings);
  diagnose_folder(machine, findings);
  return findings;
}

bool can_paint(const std::vector<Finding>& findings) {
  return std::none_of(findings.begin(), findings.end(),
                      [](const Finding& finding) { return finding.standing == Standing::hinders; });
}

}  // namespace fude
