#include "drivers/transport/uinput_device.h"

#include <fcntl.h>
#include <linux/uinput.h>
#include <sys/ioctl.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

namespace fude {
namespace {

constexpr const char* uinput_node = "/dev/uinput";

Result<FileDescriptor> open_uinput() {
  FileDescriptor file(open(uinput_node, O_WRONLY | O_CLOEXEC));
  if (file.get() >= 0) return file;
  if (errno == EACCES || errno == EPERM)
    return failure(Fault::no_access,
                   "/dev/uinput may not be written; run `sudo setfacl -m u:$USER:rw /dev/uinput`");
  return failure(Fault::not_found, "there is no /dev/uinput; run `sudo modprobe uinput`");
}

bool set_codes(int file, const DeviceDescription& device, std::span<const EvdevEvent> also) {
  const auto set = [file](unsigned long request, int value) { return ioctl(file, request, value) == 0; };
  bool done = true;
  if (!device.keys.empty()) done = done && set(UI_SET_EVBIT, EV_KEY);
  for (const std::uint16_t key : device.keys) done = done && set(UI_SET_KEYBIT, key);
  if (!device.axes.empty()) done = done && set(UI_SET_EVBIT, EV_ABS);  // UI_ABS_SETUP does not
  for (const std::uint16_t property : device.properties) done = done && set(UI_SET_PROPBIT, property);
  for (const EvdevEvent& event : also) {
    if (event.type == EV_MSC) done = done && set(UI_SET_EVBIT, EV_MSC) && set(UI_SET_MSCBIT, event.code);
    if (event.type == EV_REL) done = done && set(UI_SET_EVBIT, EV_REL) && set(UI_SET_RELBIT, event.code);
    if (event.type == EV_SW) done = done && set(UI_SET_EVBIT, EV_SW) && set(UI_SET_SWBIT, event.code);
  }
  return done;
}

bool set_axes(int file, const DeviceDescription& device) {
  for (const AxisRange& axis : device.axes) {
    uinput_abs_setup setup{};
    setup.code = axis.code;
    setup.absinfo = {.value = axis.value,
                     .minimum = axis.minimum,
                     .maximum = axis.maximum,
                     .fuzz = 0,
                     .flat = axis.flat,
                     .resolution = axis.resolution};
    if (ioctl(file, UI_ABS_SETUP, &setup) != 0) return false;
  }
  return true;
}

bool create_device(int file, const DeviceDescription& device) {
  uinput_setup setup{};
  setup.id = {device.bus, device.vendor, device.product, device.version};
  const std::string name = device.name.empty() ? "fude" : device.name;  // the kernel wants one
  std::memcpy(setup.name, name.data(), std::min(name.size(), sizeof setup.name - 1));
  return ioctl(file, UI_SET_PHYS, "fude/play") == 0 && ioctl(file, UI_DEV_SETUP, &setup) == 0 &&
         ioctl(file, UI_DEV_CREATE) == 0;
}

}  // namespace

Result<std::unique_ptr<UinputDevice>> UinputDevice::create(const DeviceDescription& device,
                                                           std::span<const EvdevEvent> also) {
  auto file = open_uinput();
  if (!file) return tl::unexpected(file.error());
  if (!set_codes(file->get(), device, also) || !set_axes(file->get(), device) ||
      !create_device(file->get(), device))
    return failure(Fault::unsupported, "the kernel makes no device of this description (" +
                                           std::string(std::strerror(errno)) + ")");
  return std::unique_ptr<UinputDevice>(new UinputDevice(std::move(*file)));
}

Result<void> UinputDevice::send(std::span<const EvdevEvent> events) {
  std::vector<input_event> raw;
  raw.reserve(events.size());
  for (const EvdevEvent& event : events) {
    input_event& last = raw.emplace_back();
    last.type = event.type;
    last.code = event.code;
    last.value = event.value;
  }
  std::span<const std::byte> left = std::as_bytes(std::span(raw));
  while (!left.empty()) {
    const ssize_t count = write(file_.get(), left.data(), left.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0)
      return failure(Fault::device_gone, "/dev/uinput takes nothing any more (" +
                                             std::string(std::strerror(errno)) + "); begin again");
    left = left.subspan(static_cast<std::size_t>(count));
  }
  return {};
}

std::filesystem::path UinputDevice::node() const {
  std::array<char, 64> name{};
  if (ioctl(file_.get(), UI_GET_SYSNAME(name.size() - 1), name.data()) < 0) return {};
  std::error_code ignored;
  const std::filesystem::path input = std::filesystem::path("/sys/devices/virtual/input") / name.data();
  for (const auto& entry : std::filesystem::directory_iterator(input, ignored))
    if (const std::string event = entry.path().filename(); event.starts_with("event"))
      return std::filesystem::path("/dev/input") / event;
  return {};
}

}  // namespace fude
