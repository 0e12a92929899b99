// The seam under every driver: whoever reads a device, a recording or a script of faults looks the
// same to what decodes it.
#pragma once

#include <optional>

#include "signal/result.h"
#include "signal/timestamp.h"
#include "signal/transfer.h"

namespace fude {

class ByteSource {
 public:
  virtual ~ByteSource() = default;

  // Blocks until a whole transfer is there, wake() was called, or the deadline on CLOCK_MONOTONIC
  // has passed (never, without one); the latter two give none. A device that goes away gives one
  // transfer `unplugged`, then fails with device_gone.
  virtual Result<std::optional<Transfer>> read(std::optional<Timestamp> deadline) = 0;

  // Sends `transfer` (its time is not used) and returns when the kernel has taken it. What it asks for
  // (hid_ask, a usb_control that reads) comes as a transfer of read(), so that a recording holds the whole
  // dialogue in order. Errors: unsupported where this source cannot send that kind, device_gone, no_access.
  virtual Result<void> write(const Transfer& transfer);

  // Ends a read() that blocks in another thread, or the next one.
  virtual void wake() = 0;
};

}  // namespace fude
