// A second listener on an input device: plain read(2), nothing of fude's.
#pragma once

#include <filesystem>
#include <vector>

#include "drivers/transport/file_descriptor.h"
#include "signal/transfer.h"

namespace fude::lab {

struct RawFrame {
  Timestamp time{};  // of its SYN_REPORT, on CLOCK_MONOTONIC
  std::vector<EvdevEvent> events;
};

class RawEvents {
 public:
  explicit RawEvents(const std::filesystem::path& node);

  // The frames that came since the last call.
  std::vector<RawFrame> take();

 private:
  FileDescriptor file_;
  RawFrame open_;
};

}  // namespace fude::lab
