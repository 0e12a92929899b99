#include "tests/fakes/falcon_arm.h"

#include "drivers/byte_order.h"
#include "drivers/falcon/ftdi.h"

namespace fude {
namespace {

// The chip speaks up each millisecond, be it with its status alone.
constexpr Duration latency = std::chrono::milliseconds(1);

}  // namespace

std::vector<std::byte> PowerOn::hear(const Transfer& sent) {
  if (sent.kind != TransferKind::usb_bulk) return {};
  if (loaded())
    return falcon::read_to_arm(sent.payload) ? falcon::write_from_arm({.homed = 7})
                                             : std::vector<std::byte>{};
  if (sent.payload == octets({0x0a, 0x43, 0x0d})) return octets({0x00, 0x0a, 0x44, 0x2c, 0x0d});
  if (sent.payload == octets({0x41})) {
    receiving_ = true;
    received_.clear();
    return octets({0x41});
  }
  if (!receiving_) return {};
  append(received_, sent.payload);
  auto echo = sent.payload;
  if (spoil_ > 0 && --spoil_ == 0) echo[0] ^= std::byte{1};
  return echo;
}

Transfer FalconArm::packet(const std::vector<std::byte>& bytes) const {
  Transfer transfer{.time = clock_.now(),
                    .stamped_by = StampedBy::arrival,
                    .kind = TransferKind::usb_bulk,
                    .payload = octets({0x01, 0x60}),
                    .endpoint = falcon::bulk_in};
  append(transfer.payload, bytes);
  return transfer;
}

Result<std::optional<Transfer>> FalconArm::read(std::optional<Timestamp>) {
  if (gone) {
    if (std::exchange(told_gone_, true)) return failure(Fault::device_gone, "gone");
    return Transfer{.time = clock_.now(), .stamped_by = StampedBy::arrival, .kind = TransferKind::unplugged};
  }
  if (!instead.empty()) {
    Transfer transfer = std::move(instead.front());
    instead.pop_front();
    return transfer;
  }
  if (flooding) return packet(octets({0x3c, 0x41, 0x3e, 0xff}));
  if (!answers_.empty() && !muted) {
    const Transfer transfer = packet(answers_.front());
    answers_.pop_front();
    return transfer;
  }
  if (clock_.now() < next_status_) return std::nullopt;
  next_status_ = clock_.now() + latency;
  return packet({});
}

Result<void> FalconArm::write(const Transfer& transfer) {
  if (gone) return failure(Fault::device_gone, "gone");
  if (full) return failure(Fault::busy, "takes nothing");
  // The chip sends what it has in packets of 64 with two of status.
  constexpr std::size_t most = 62;
  const std::vector<std::byte> all = answer(transfer);
  for (std::size_t at = 0; at < all.size(); at += most) {
    const Bytes piece = Bytes(all).subspan(at, std::min(most, all.size() - at));
    answers_.emplace_back(piece.begin(), piece.end());
  }
  return {};
}

std::vector<std::byte> FalconArm::answer(const Transfer& transfer) {
  if (!firmware.loaded()) return firmware.hear(transfer);
  if (transfer.kind != TransferKind::usb_bulk) return {};
  const auto message = falcon::read_to_arm(transfer.payload);
  if (!message) return {};
  sent.push_back({clock_.now(), *message});
  return falcon::write_from_arm(state);
}

}  // namespace fude
