// A 3Dconnexion SpaceMouse: six axes and buttons.
#pragma once

#include <cstdint>

#include "drivers/decoder.h"
#include "drivers/spacemouse/report.h"

namespace fude {

// Reads hid_report transfers. Each report that tells of motion or buttons gives one PuckSample with all
// that is known by then: push and turn come in two reports on the older models, at one moment of the
// device's. It has no clock and no number of its own, so a loss cannot be seen.
class SpaceMouseDecoder final : public Decoder {
 public:
  SpaceMouseDecoder(std::uint16_t vendor, std::uint16_t product);

  void decode(const Transfer& transfer, Decoded& out) override;

 private:
  spacemouse::Model model_;
  PuckSample state_;
  std::uint64_t sequence_ = 0;
  bool after_gap_ = false;
};

}  // namespace fude
