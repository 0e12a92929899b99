// A HID device made of a report descriptor, for the kernel's own HID drivers to bind to.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "drivers/transport/file_descriptor.h"
#include "drivers/transport/waker.h"

namespace fude::lab {

using Bytes = std::vector<std::byte>;

struct HidIdentity {
  std::string name;
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
  std::string serial;
};

// Throws std::system_error where /dev/uhid is refused. Lives until it is destroyed, which unplugs it.
class UhidDevice {
 public:
  UhidDevice(const HidIdentity& identity, std::span<const std::byte> descriptor);
  ~UhidDevice();

  // One input report, its number first where the descriptor has numbers. When this returns, the kernel
  // has handed it to everyone who listens.
  void send(std::span<const std::byte> report);

  // What a GET_REPORT of this feature number is answered with; SET_REPORT puts new bytes there. A number
  // that was never set is refused, as a device does.
  void set_feature(Bytes report);
  Bytes feature(std::uint8_t number);
  // Output reports that came in, oldest first.
  std::vector<Bytes> outputs();

 private:
  void answer();

  FileDescriptor file_;
  Waker waker_;
  std::mutex mutex_;
  std::map<std::uint8_t, Bytes> features_;
  std::vector<Bytes> outputs_;
  std::thread thread_;
};

}  // namespace fude::lab
