// fude's own ultrasonic receiver board on a serial line.
#pragma once

#include <optional>
#include <vector>

#include "drivers/decoder.h"
#include "drivers/numbered_stream.h"
#include "drivers/ultrasonic/packet.h"

namespace fude {

// Reads serial transfers. greeting() ends whatever stood half on the line, asks who the board is and lets
// it start. Each pulse is one RangeSample, stamped as its last byte's transfer, with device_tick in
// microseconds (when the pulse left).
class UltrasonicDecoder final : public Decoder {
 public:
  std::vector<Transfer> greeting() override;
  void decode(const Transfer& transfer, Decoded& out) override;

  const std::optional<ultrasonic::Board>& board() const { return board_; }

 private:
  void take_packet(Bytes packet, const Transfer& transfer, Decoded& out);
  void take_pulse(const ultrasonic::Pulse& pulse, const Transfer& transfer, Decoded& out);

  std::vector<std::byte> line_;  // since the last zero
  bool overflowed_ = false;
  std::optional<ultrasonic::Board> board_;
  NumberedStream stream_;
};

}  // namespace fude
