// Pens read as raw HID reports: from recordings, and where no kernel driver stands between.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "drivers/decoder.h"
#include "drivers/tablet/hid_pen_standard.h"
#include "signal/device.h"

namespace fude {

// The device as a pen tablet (kind, axes and size completed as far as its model, its report descriptor or its
// reports tell; what the description states already stays), or none where neither those nor any of its
// reports show a pen that is known.
std::optional<DeviceDescription> described_hid_pen(DeviceDescription device,
                                                   std::span<const Transfer> transfers);

// Reads hid_report transfers of a device that described_hid_pen has completed: Wacom's layouts by model, else
// by the report descriptor, else UC-Logic's by what the report is like. Host time is the transfer's, the
// sequence counts samples. Angles follow the kernel's signs.
class HidPenDecoder final : public Decoder {
 public:
  explicit HidPenDecoder(const DeviceDescription& device);

  void decode(const Transfer& transfer, Decoded& out) override;

 private:
  hid_pen::PenReport read(Bytes report);

  std::optional<hid_pen::WacomModel> wacom_;
  std::vector<hid_pen::StandardPen> standard_;
  bool may_be_uclogic_ = false;
  std::int32_t greatest_pressure_ = 0;  // of UC-Logic's; 0: as its makers state
  PenSample pen_;
  std::uint64_t sequence_ = 0;
  bool after_gap_ = false;
};

}  // namespace fude
