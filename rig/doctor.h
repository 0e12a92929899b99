// Whether one can paint on this machine: what was looked at, what it means, and the one command that mends
// it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "signal/timestamp.h"

namespace fude {

// A device of a family that fude drives, as it is plugged in.
struct PluggedDevice {
  std::string name;
  std::filesystem::path node;
  bool pen_tablet = false;
  bool camera = false;
  bool access = false;
};

struct OpenGlFound {
  std::string version;
  std::string renderer;
  bool software = false;
};

// What was found on a machine. Reading it off the real one is examine_machine(); a test writes its own.
struct Machine {
  bool udev = true;  // it answers
  std::vector<PluggedDevice> devices;
  std::optional<std::filesystem::path> rule;  // fude's, where udev reads it
  std::filesystem::path own_rule;             // where fude keeps it; empty where it does not
  bool root = false;                          // the user is
  std::vector<std::string> groups;            // of the user
  bool uinput_there = false, uinput_writable = false;
  bool display = false;  // one that a window can open on
  std::optional<OpenGlFound> opengl;
  std::string no_opengl;         // why there is none
  std::filesystem::path folder;  // where sessions are to go
  bool folder_writable = false;
  std::uintmax_t free_bytes = 0;        // in the folder, for the user
  std::optional<Duration> stamp_ahead;  // of a file made there, against the machine's clock
};

enum class Standing : std::uint8_t {
  good,
  lacking,  // something is not there; one can paint without it
  hinders,  // no painting before it is mended
};

struct Finding {
  std::string subject;  // "udev rule"
  Standing standing = Standing::good;
  std::string says;     // one line
  std::string command;  // that mends it; empty where it is good or no command can
};

std::vector<Finding> diagnose(const Machine& machine);

// Where nothing hinders: a window can open, each pen tablet that is plugged in may be read, and the folder
// takes sessions.
bool can_paint(const std::vector<Finding>& findings);

// Looks at this machine. `folder` is where sessions are to go.
Machine examine_machine(const std::filesystem::path& folder);

// The parts of it that are files: under `root`, "/" on the real machine.
std::optional<std::filesystem::path> installed_rule(const std::filesystem::path& root);
void examine_folder(const std::filesystem::path& folder, Machine& machine);

}  // namespace fude
