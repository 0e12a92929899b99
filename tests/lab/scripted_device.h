// A USB device whose every answer is a test's: one interface of a gadget, by FunctionFS.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "drivers/transport/file_descriptor.h"
#include "drivers/transport/waker.h"
#include "tests/lab/usb_gadget.h"

namespace fude::lab {

using Bytes = std::vector<std::byte>;

struct ScriptedEndpoint {
  std::uint8_t address = 0;  // bit 7: to the host
  bool bulk = false;         // else interrupt
  std::uint16_t packet = 64;
};

struct ScriptedInterface {
  std::uint8_t usb_class = 0xff;
  std::vector<ScriptedEndpoint> endpoints;
  Bytes hid_descriptor;  // of a HID device (usb_class 3): its report descriptor
  std::uint8_t subclass = 0;
  std::uint8_t protocol = 0;
};

// A request to the interface or, of a vendor, to the device. To the host (bit 7 of the first byte): what it
// is answered with; from the host: `data` came, and any answer accepts it. None refuses (stalls).
struct ScriptedRequest {
  std::uint8_t type = 0;
  std::uint8_t request = 0;
  std::uint16_t value = 0;
  std::uint16_t index = 0;
  Bytes data;
};
using Answer = std::function<std::optional<Bytes>(const ScriptedRequest&)>;

class ScriptedDevice {
 public:
  // Plugged in when this returns. Reading its own report descriptor is answered here.
  ScriptedDevice(const UsbIdentity& identity, int port, const ScriptedInterface& interface,
                 Answer answer = {});
  ~ScriptedDevice();
  ScriptedDevice(const ScriptedDevice&) = delete;
  ScriptedDevice& operator=(const ScriptedDevice&) = delete;

  // Until the host has taken it. False when the device was unplugged meanwhile.
  bool send(std::uint8_t address, const Bytes& bytes);
  // One transfer from the host; none when the device was unplugged.
  std::optional<Bytes> receive(std::uint8_t address);
  // Halts an endpoint; the host has to clear it.
  void stall(std::uint8_t address);

  void plug();
  void unplug();

 private:
  void describe();
  ssize_t patiently(const std::function<ssize_t()>& transfer);
  void serve();
  void answer(const ScriptedRequest& request, std::uint16_t length);

  std::string name_;
  ScriptedInterface interface_;
  Answer answer_;
  UsbGadget gadget_;
  FileDescriptor control_;
  std::map<std::uint8_t, FileDescriptor> endpoints_;
  std::atomic<bool> plugged_ = false;
  Waker waker_;
  std::thread thread_;
};

}  // namespace fude::lab
