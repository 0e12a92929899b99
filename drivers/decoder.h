// What every family's driver does: from the bytes of a device to samples, and to the bytes that are to
// be sent back. It reads no clock and no file, so a recording runs through it as the device did.
#pragma once

#include <cstdint>
#include <vector>

#include "signal/sample.h"
#include "signal/transfer.h"

namespace fude {

// What the decoding met; nothing is lost without a count.
struct ReportCounts {
  std::uint64_t reports = 0;    // understood
  std::uint64_t samples = 0;    // made of them
  std::uint64_t lost = 0;       // missing in the device's own count, at least one a gap
  std::uint64_t malformed = 0;  // wrong length, number or checksum; each is skipped
  std::uint64_t unknown = 0;    // well formed, but of a kind that this driver does not read
  bool operator==(const ReportCounts&) const = default;
};

struct Decoded {
  std::vector<Sample> samples;
  std::vector<Transfer> replies;  // to be written to the device, in this order
};

class Decoder {
 public:
  virtual ~Decoder() = default;

  // What to send when the device has appeared (again), before its first report.
  virtual std::vector<Transfer> greeting() { return {}; }

  // Adds to `out`. Transfers of a direction or kind that the family does not have are ignored; bytes of
  // any content are safe. `unplugged` and `suspended` forget the state and mark the next sample `after_gap`.
  virtual void decode(const Transfer& transfer, Decoded& out) = 0;

  const ReportCounts& counts() const { return counts_; }

 protected:
  ReportCounts counts_;
};

}  // namespace fude
