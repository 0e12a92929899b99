// Whoever speaks OpenIGTLink: PLUS, 3D Slicer, and through them most trackers of surgery.
#pragma once

#include <cstdint>

#include "drivers/decoder.h"
#include "drivers/openigtlink/message.h"

namespace fude {

// Reads message transfers, one whole message each (openigtlink::fit_message finds them in a stream).
// TRANSFORM, TDATA, QTDATA, POSITION and QTRANS give PoseSamples, named by the device or the tool; a POSITION
// without a turn gives a PositionSample. The peer's stamp is the device_tick, microseconds since 1970.
// All tools of a message have one sequence, which counts messages; the protocol shows no loss.
class OpenIgtLinkDecoder final : public Decoder {
 public:
  void decode(const Transfer& transfer, Decoded& out) override;

 private:
  // False where the content is none of its type; unknown types are counted here.
  bool take(const openigtlink::Message& message, const Transfer& transfer, Decoded& out);

  std::uint64_t sequence_ = 0;
  bool after_gap_ = false;
};

}  // namespace fude
