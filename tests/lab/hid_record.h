// Report descriptors and reports as they were read from real devices.
#pragma once

#include <filesystem>
#include <vector>

#include "tests/lab/uhid_device.h"

namespace fude::lab {

struct HidRecord {
  Bytes descriptor;
  std::vector<Bytes> reports;
};

// The first interface of a hid-recorder file: its R: line and its E: lines.
HidRecord read_hid_record(const std::filesystem::path& file);

Bytes read_bytes(const std::filesystem::path& file);

}  // namespace fude::lab
