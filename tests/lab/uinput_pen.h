// A pen tablet that the kernel makes at our word.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "drivers/transport/file_descriptor.h"
#include "signal/transfer.h"

namespace fude::lab {

// X and Y from 0 to 20000, pressure from 0 to 2047. Destroying it unplugs it. Throws std::system_error.
class UinputPen {
 public:
  explicit UinputPen(const std::string& name);

  void send(std::span<const EvdevEvent> events);
  // A frame that moves the pen, which is near and touches.
  void move(std::int32_t x, std::int32_t y, std::int32_t pressure);

 private:
  FileDescriptor file_;
};

}  // namespace fude::lab
