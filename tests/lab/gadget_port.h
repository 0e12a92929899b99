// The device's side of a gadget's serial port ("acm.lab").
#pragma once

#include <fcntl.h>
#include <termios.h>
#include <unistd.h>

#include <cstddef>
#include <fstream>
#include <string>
#include <vector>

#include "drivers/transport/file_descriptor.h"
#include "tests/lab/usb_gadget.h"

namespace fude::lab {

class GadgetPort {
 public:
  explicit GadgetPort(const UsbGadget& gadget) {
    int number = 0;
    std::ifstream(gadget.function("acm.lab") / "port_num") >> number;
    file_ =
        FileDescriptor(open(("/dev/ttyGS" + std::to_string(number)).c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC));
    termios settings{};
    tcgetattr(file_.get(), &settings);
    cfmakeraw(&settings);
    tcsetattr(file_.get(), TCSANOW, &settings);
  }

  // False when the device was unplugged.
  bool send(const std::vector<std::byte>& sent) {
    return write(file_.get(), sent.data(), sent.size()) == static_cast<ssize_t>(sent.size());
  }
  // `count` bytes, fewer when the device was unplugged.
  std::vector<std::byte> receive(std::size_t count) {
    std::vector<std::byte> received(count);
    std::size_t at = 0;
    while (at < count) {
      const ssize_t size = read(file_.get(), received.data() + at, count - at);
      if (size <= 0) break;
      at += static_cast<std::size_t>(size);
    }
    received.resize(at);
    return received;
  }

 private:
  FileDescriptor file_;
};

}  // namespace fude::lab
