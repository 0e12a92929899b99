// A Novint Falcon: firmware, position, and the force that was sent to it.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "drivers/decoder.h"
#include "drivers/falcon/firmware_load.h"
#include "drivers/falcon/message.h"
#include "drivers/frame_stream.h"

namespace fude {

// Reads usb_bulk transfers. greeting() sends a message as to an arm that runs; where none comes back within
// 200 ms the firmware is loaded, if there is an image. Every message from the arm is one HapticSample with
// the position from its middle; `homed` when all three legs know their zero. `force_n` is what the last
// message to the arm asks of its motors, so to_device transfers are read too. No clock and no number: a loss
// cannot be seen.
//
// With `polls` it answers each message by one without force, which keeps the arm talking; whoever runs a
// HapticLoop over it says that himself.
class FalconDecoder final : public Decoder {
 public:
  enum class State : std::uint8_t { unknown, loading, running, no_firmware, failed };

  explicit FalconDecoder(std::vector<std::byte> firmware = {}, bool polls = true);

  std::vector<Transfer> greeting() override;
  void decode(const Transfer& transfer, Decoded& out) override;

  State state() const { return state_; }

 private:
  void take_message(const falcon::FromArm& message, const Transfer& transfer, Decoded& out);
  void wait(const Transfer& transfer, Decoded& out);
  Eigen::Vector3d velocity_at(Timestamp now, const Eigen::Vector3d& position);
  void poll(std::uint8_t light, Decoded& out);

  bool polls_;
  bool has_firmware_;
  falcon::FirmwareLoad load_;
  State state_ = State::unknown;
  std::optional<Timestamp> silent_since_;
  FrameStream stream_;
  Eigen::Vector3d position_m_;  // before the base
  Eigen::Vector3d torques_nm_ = Eigen::Vector3d::Zero();
  std::deque<std::pair<Timestamp, Eigen::Vector3d>> before_;
  std::uint64_t sequence_ = 0;
  bool after_gap_ = false;
};

namespace falcon {

// The middle of the workspace, before the base.
Eigen::Vector3d workspace_middle();

// The message that gives this force at a position before the base: torques by the Jacobian, scaled down
// together where one motor's limit is passed (so that the direction stays); no force where there is no
// Jacobian.
ToArm force_message(const Eigen::Vector3d& position_m, const Eigen::Vector3d& force_n, std::uint8_t light);

}  // namespace falcon

}  // namespace fude
