// A USB serial port (CDC ACM) whose every byte is a test's.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "tests/lab/scripted_device.h"

namespace fude::lab {

class ScriptedPort {
 public:
  // Plugged in when this returns.
  ScriptedPort(const UsbIdentity& identity, int port) : device_(identity, port, interface(), accept) {}

  // Until the host has taken it. False when the device was unplugged meanwhile.
  bool send(const Bytes& bytes) { return device_.send(to_host, bytes); }
  // `count` bytes or a few more, as the host packs them; fewer when the device was unplugged.
  Bytes receive(std::size_t count) {
    Bytes received;
    while (received.size() < count) {
      const auto packet = device_.receive(from_host);
      if (!packet) break;
      received.insert(received.end(), packet->begin(), packet->end());
    }
    return received;
  }
  void plug() { device_.plug(); }
  void unplug() { device_.unplug(); }

 private:
  static constexpr std::uint8_t to_host = 0x81;
  static constexpr std::uint8_t from_host = 0x02;
  static constexpr std::uint8_t notifications = 0x83;  // none is ever sent

  // All three endpoints in one interface: what the kernel's driver takes for a port where no descriptor
  // names a second (cdc-acm, "assuming single interface").
  static ScriptedInterface interface() {
    constexpr std::uint8_t communications = 2, abstract_control = 2, at_commands = 1;
    return {.usb_class = communications,
            .endpoints = {{notifications, false, 16}, {to_host, true}, {from_host, true}},
            .hid_descriptor = {},
            .subclass = abstract_control,
            .protocol = at_commands};
  }

  // The host sets the line's speed, its control lines and breaks (USB PSTN 1.2, 6.3).
  static std::optional<Bytes> accept(const ScriptedRequest& request) {
    constexpr std::uint8_t of_the_class = 0x21;
    return request.type == of_the_class ? std::optional(Bytes{}) : std::nullopt;
  }

  ScriptedDevice device_;
};

}  // namespace fude::lab
