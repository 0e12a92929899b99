// The pen of a tablet as every other family's driver.
#pragma once

#include <algorithm>

#include "drivers/decoder.h"
#include "drivers/tablet/pen_decoder.h"

namespace fude {

class TabletDecoder final : public Decoder {
 public:
  explicit TabletDecoder(const DeviceDescription& device) : pen_(device) {}

  void decode(const Transfer& transfer, Decoded& out) override {
    if (const auto sample = pen_.decode(transfer)) out.samples.emplace_back(*sample);
    const DecodeCounts& met = pen_.counts();
    // A stale frame after a drop is counted among the frames and among the lost.
    counts_ = {.reports = met.frames - std::min(met.lost, met.frames), .samples = met.samples, .lost = met.lost, .malformed = met.malformed};
  }

 private:
  PenDecoder pen_;
};

}  // namespace fude
