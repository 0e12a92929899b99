// A Linux input device, read by libevdev in whole frames stamped by the kernel.
#pragma once

#include <libevdev/libevdev.h>

#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "drivers/transport/file_descriptor.h"
#include "drivers/transport/waker.h"
#include "signal/byte_source.h"
#include "signal/device.h"
#include "signal/result.h"

namespace fude {

class EvdevSource final : public ByteSource {
 public:
  // Opens e.g. /dev/input/event5 and asks for monotonic time stamps; a kernel that refuses gets
  // its frames stamped on arrival. Errors: no_access with the command that mends it, not_found,
  // unsupported for a file that is no input device.
  static Result<std::unique_ptr<EvdevSource>> open(const std::filesystem::path& node);

  // As the kernel describes the device now, axis values included; see identified().
  const DeviceDescription& description() const { return description_; }

  // After SYN_DROPPED the frame cut by it is given as {…, SYN_DROPPED, SYN_REPORT}, which decoding
  // discards as a gap, and then what changed meanwhile as a frame of its own.
  Result<std::optional<Transfer>> read(std::optional<Timestamp> deadline) override;
  void wake() override { waker_.wake(); }

 private:
  using Device = std::unique_ptr<libevdev, decltype(&libevdev_free)>;
  EvdevSource(FileDescriptor file, Device device);

  void tell_held_keys();
  void take_events();
  void resynchronise();
  Timestamp stamp_of(const input_event& event) const;
  void close_frame(Timestamp time, StampedBy stamped_by);
  void unplugged();

  FileDescriptor file_;
  Device device_;
  DeviceDescription description_;
  StampedBy stamped_by_ = StampedBy::kernel;
  Waker waker_;
  std::vector<EvdevEvent> frame_;
  std::deque<Transfer> ready_;
  bool gone_ = false;
};

// What the kernel knows of an open device; the serial is what the device calls unique.
DeviceDescription describe(const libevdev* device);

}  // namespace fude
