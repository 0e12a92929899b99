#include "drivers/transport/device_node.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <sstream>
#include <utility>

namespace fude {
namespace {

// A line of /proc/locks: "1: FLOCK  ADVISORY  WRITE 714 00:05:278 0 EOF", with the process and the file's
// device and inode.
std::string holder(int file) {
  struct stat status {};
  fstat(file, &status);
  char file_place[64];
  std::snprintf(file_place, sizeof file_place, "%02x:%02x:%llu", major(status.st_dev), minor(status.st_dev),
                static_cast<unsigned long long>(status.st_ino));
  std::ifstream locks("/proc/locks");
  for (std::string line; std::getline(locks, line);) {
    std::istringstream words(line);
    std::string number, kind, mode, way, process, place;
    words >> number >> kind >> mode >> way >> process >> place;
    if (kind != "FLOCK" || place != file_place) continue;
    std::string name;
    std::getline(std::ifstream("/proc/" + process + "/comm"), name);
    return name.empty() ? "process " + process : name + " (process " + process + ")";
  }
  return "another program";
}

}  // namespace

Result<void> hold_alone(int file, const std::filesystem::path& node) {
  if (flock(file, LOCK_EX | LOCK_NB) == 0) return {};
  return failure(Fault::busy, node.string() + " is held by " + holder(file) + "; end it first");
}

Result<FileDescriptor> open_alone(const std::filesystem::path& node) {
  FileDescriptor file(open(node.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC | O_NOCTTY));
  if (file.get() < 0) {
    if (errno == EACCES || errno == EPERM) return failure(Fault::no_access, access_advice(node));
    if (errno == EBUSY)
      return failure(Fault::busy, node.string() + " is held by another program; end it first");
    return failure(Fault::not_found,
                   node.string() + ": " + std::strerror(errno) + "; is the device plugged in?");
  }
  if (auto held = hold_alone(file.get(), node); !held) return tl::unexpected(held.error());
  return file;
}

std::string access_advice(const std::filesystem::path& node) {
  return "no permission to open " + node.string() +
         "; the udev rule 70-fude.rules gives it to whoever is logged in: `sudo cp share/udev/70-fude.rules "
         "/etc/udev/rules.d/ && sudo udevadm control --reload && sudo udevadm trigger`";
}

}  // namespace fude
