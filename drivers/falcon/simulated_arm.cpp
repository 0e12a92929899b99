#include "drivers/falcon/simulated_arm.h"

#include <algorithm>
#include <cmath>

#include "drivers/byte_order.h"
#include "drivers/falcon/falcon_decoder.h"
#include "drivers/falcon/ftdi.h"
#include "drivers/falcon/kinematics.h"
#include "drivers/falcon/message.h"

namespace fude::falcon {
namespace {

constexpr Duration status_period = std::chrono::milliseconds(1);

Transfer packet(Bytes bytes) {
  Transfer transfer = bulk(octets({0x01, 0x60}));
  append(transfer.payload, bytes);
  transfer.time = monotonic_now();
  transfer.stamped_by = StampedBy::arrival;
  transfer.direction = Direction::from_device;
  transfer.endpoint = bulk_in;
  return transfer;
}

std::int16_t encoder_counts(double angle) {
  return static_cast<std::int16_t>(std::lround((angle - leg_angle(0)) / (leg_angle(1) - leg_angle(0))));
}

}  // namespace

Result<std::optional<Transfer>> SimulatedArm::read(std::optional<Timestamp> deadline) {
  for (;;) {
    if (auto answer = inbox_.take()) return answer;
    const Timestamp now = monotonic_now();
    if (now >= next_status_) {
      next_status_ = now + status_period;
      return packet({});
    }
    if (deadline && *deadline <= now) return std::nullopt;
    if (inbox_.wait(-1, deadline ? std::min(*deadline, next_status_) : next_status_).woken)
      return std::nullopt;
  }
}

Result<void> SimulatedArm::write(const Transfer& transfer) {
  if (transfer.kind != TransferKind::usb_bulk || !read_to_arm(transfer.payload)) return {};
  if (const auto angles = leg_angles(workspace_middle() + hand_(monotonic_now()))) angles_ = *angles;
  FromArm answer{.homed = 7};
  for (std::size_t i = 0; i < 3; ++i)
    answer.encoders[i] = encoder_counts(angles_[static_cast<Eigen::Index>(i)]);
  inbox_.put(packet(write_from_arm(answer)));
  return {};
}

}  // namespace fude::falcon
