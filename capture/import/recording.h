// What an importer makes of someone else's file: the device as the file describes it and what it
// sent. Raw events stay raw; the drivers decode them. Text formats hold finished samples instead.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "signal/device.h"
#include "signal/sample.h"
#include "signal/transfer.h"

namespace fude {

struct ImportCounts {
  std::uint64_t events = 0;           // input events or text rows, with their SYN_REPORTs
  std::uint64_t frames = 0;           // closed by a SYN_REPORT
  std::uint64_t ignored_lines = 0;    // comments and blanks
  std::uint64_t unclosed_events = 0;  // after the last SYN_REPORT: the recording stopped inside a frame
  std::uint64_t still_times = 0;      // frames or rows stamped with the time of the one before
  bool operator==(const ImportCounts&) const = default;
};

struct RawRecording {
  std::optional<DeviceDescription> device;  // none: the events cannot be decoded, only kept
  std::vector<Transfer> transfers;          // stamped by the recording, time never decreasing
  std::vector<Sample> samples;              // of files that hold finished values
  ImportCounts counts;
  std::map<std::string, std::uint64_t> passed_over;  // what could not be understood, and how often
};

}  // namespace fude
