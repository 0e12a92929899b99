// Which driver reads what a recording holds: by the device as it is described, and by its bytes.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "drivers/decoder.h"
#include "drivers/tablet/pen_decoder.h"
#include "signal/device.h"

namespace fude {

// One decoder for all families; the pen of an evdev tablet has counts of its own.
class RecordedDriver {
 public:
  // `device` as its recording describes it, perhaps not at all; `transfers` all of them.
  RecordedDriver(std::optional<DeviceDescription> device, std::span<const Transfer> transfers);

  const DeviceDescription& device() const { return device_; }  // completed by the driver
  bool decodes() const { return evdev_.has_value() || decoder_ != nullptr; }
  void decode(const Transfer& transfer, std::vector<Sample>& out);

  std::uint64_t lost() const;
  std::uint64_t out_of_range() const { return evdev_ ? evdev_->counts().out_of_range : 0; }
  std::uint64_t not_understood() const;  // malformed or unknown to the driver; of reports

 private:
  DeviceDescription device_;
  std::optional<PenDecoder> evdev_;
  std::unique_ptr<Decoder> decoder_;
};

}  // namespace fude
