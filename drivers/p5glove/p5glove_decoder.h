// Essential Reality's P5 Glove: five bend sensors, buttons, and eight lights that a tower sees.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "drivers/decoder.h"
#include "drivers/p5glove/report.h"

namespace fude {

// Reads hid_report and hid_feature transfers. greeting() ends its mouse mode and asks for the tower's
// calibration; until that has come, no light has a place. A tangent beyond its ten bits is unwrapped by
// the report before. No clock, no number: a loss cannot be seen.
class P5GloveDecoder final : public Decoder {
 public:
  std::vector<Transfer> greeting() override;
  void decode(const Transfer& transfer, Decoded& out) override;

  const std::optional<p5glove::Tower>& tower() const { return tower_; }

 private:
  void take_report(const p5glove::Report& report, const Transfer& transfer, Decoded& out);
  void take_feature(const Transfer& transfer);

  std::vector<std::byte> heads_;
  std::vector<std::byte> lights_;
  std::optional<p5glove::Tower> tower_;
  std::array<std::optional<p5glove::Sighting>, glove_lights> seen_{};  // in the report before
  std::uint64_t sequence_ = 0;
  bool after_gap_ = false;
};

}  // namespace fude
