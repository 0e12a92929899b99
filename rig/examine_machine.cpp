#include <fcntl.h>
#include <grp.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <ctime>

#include "drivers/transport/file_descriptor.h"
#include "rig/attached_devices.h"
#include "rig/doctor.h"
#include "rig/share_folder.h"
#ifdef FUDE_OPENGL
#include "sim/compute/gl_context.h"
#endif

namespace fude {
namespace {

namespace fs = std::filesystem;

constexpr const char* rule_name = "70-fude";
constexpr const char* uinput_node = "/dev/uinput";

void find_devices(Machine& machine) {
  const auto devices = attached_devices();
  machine.udev = devices.has_value();
  if (!devices) return;
  for (const AttachedDevice& device : *devices)
    machine.devices.push_back({device.description.name, device.node,
                               device.description.kind == DeviceKind::pen_tablet,
                               device.description.kind == DeviceKind::camera, device.access});
}

std::vector<std::string> own_groups() {
  std::array<gid_t, 256> numbers{};
  const int count = getgroups(numbers.size(), numbers.data());
  std::vector<std::string> names;
  for (int i = 0; i < count; ++i)
    if (const group* entry = getgrgid(numbers[static_cast<std::size_t>(i)]))
      names.emplace_back(entry->gr_name);
  return names;
}

bool set_in_environment(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr && *value != '\0';
}

void find_opengl(Machine& machine) {
#ifdef FUDE_OPENGL
  const auto context = GlContext::open(GlContext::Renderer::any);
  if (context)
    machine.opengl = {context->version(), context->renderer(), is_software_renderer(context->renderer())};
  else
    machine.no_opengl = context.error().message;
#else
  machine.no_opengl = "this fude was built without it";
#endif
}

}  // namespace

std::optional<fs::path> installed_rule(const fs::path& root) {
  std::error_code ignored;
  for (const char* folder : {"etc/udev/rules.d", "run/udev/rules.d", "usr/local/lib/udev/rules.d",
                             "usr/lib/udev/rules.d", "lib/udev/rules.d"}) {
    const fs::path file = root / folder / (std::string(rule_name) + ".rules");
    if (fs::is_regular_file(file, ignored)) return file;
  }
  return std::nullopt;
}

void examine_folder(const fs::path& folder, Machine& machine) {
  machine.folder = folder;
  std::error_code error;
  const fs::space_info space = fs::space(folder, error);
  if (!error) machine.free_bytes = space.available;
  std::string name = (folder / ".fude-XXXXXX").string();
  const FileDescriptor file(mkostemp(name.data(), O_CLOEXEC));
  machine.folder_writable = file.get() >= 0;
  if (!machine.folder_writable) return;
  unlink(name.c_str());
  struct stat stamped {};
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  if (write(file.get(), "fude", 4) != 4 || fstat(file.get(), &stamped) != 0) return;
  machine.stamp_ahead = std::chrono::seconds(stamped.st_mtim.tv_sec - now.tv_sec) +
                        Duration(stamped.st_mtim.tv_nsec - now.tv_nsec);
}

Machine examine_machine(const fs::path& folder) {
  Machine machine;
  find_devices(machine);
  machine.rule = installed_rule("/");
  if (const auto own = find_shared("udev", rule_name, ".rules")) machine.own_rule = *own;
  machine.root = geteuid() == 0;
  machine.groups = own_groups();
  machine.uinput_there = access(uinput_node, F_OK) == 0;
  machine.uinput_writable = access(uinput_node, W_OK) == 0;
  machine.display = set_in_environment("WAYLAND_DISPLAY") || set_in_environment("DISPLAY");
  find_opengl(machine);
  examine_folder(folder, machine);
  return machine;
}

}  // namespace fude
