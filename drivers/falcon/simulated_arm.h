// A Falcon made of nothing, for measuring the loop: it runs its firmware, and a hand that no force moves
// leads it.
#pragma once

#include <Eigen/Core>
#include <functional>

#include "drivers/transport/inbox.h"
#include "signal/byte_source.h"

namespace fude::falcon {

class SimulatedArm final : public ByteSource {
 public:
  // Metres from the middle of the workspace; where the legs do not reach, the arm stays where it was.
  using Hand = std::function<Eigen::Vector3d(Timestamp)>;

  explicit SimulatedArm(Hand hand) : hand_(std::move(hand)) {}

  // Its answers, and between them each millisecond the status of its serial chip.
  Result<std::optional<Transfer>> read(std::optional<Timestamp> deadline) override;

  // Answers each message with where the hand is now; takes all else in silence.
  Result<void> write(const Transfer& transfer) override;
  void wake() override { inbox_.wake(); }

 private:
  Hand hand_;
  Inbox inbox_;
  Eigen::Vector3d angles_ = Eigen::Vector3d::Zero();
  Timestamp next_status_{};
};

}  // namespace fude::falcon
