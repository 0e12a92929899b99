// Whoever serves VRPN trackers: OptiTrack Motive, Vicon, Qualisys.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "drivers/decoder.h"
#include "drivers/vrpn/message.h"

namespace fude {

// Reads message transfers, one frame of vrpn::fit_message each. greeting() is the cookie. A Pos_Quat
// gives a PoseSample whose tool is the sender's name, and "name/2" for its sensor 2; the peer's stamp is
// the device_tick, microseconds since 1970. Each sample has a sequence of its own; the protocol shows no
// loss.
class VrpnDecoder final : public Decoder {
 public:
  std::vector<Transfer> greeting() override;
  void decode(const Transfer& transfer, Decoded& out) override;

 private:
  bool take(const vrpn::Message& message, const Transfer& transfer, Decoded& out);

  std::map<std::int32_t, std::string> senders_;
  std::map<std::int32_t, std::string> types_;
  std::uint64_t sequence_ = 0;
  bool after_gap_ = false;
};

}  // namespace fude
