#include "drivers/falcon/ftdi.h"

#include <algorithm>
#include <utility>

namespace fude::falcon {
namespace {

constexpr std::size_t packet_length = 64;
constexpr std::size_t status_length = 2;

// The setup packet: vendor request to the device, number, value, index 0, no data.
Transfer request(unsigned number, unsigned value) {
  Transfer transfer;
  transfer.direction = Direction::to_device;
  transfer.kind = TransferKind::usb_control;
  transfer.payload = octets({0x40, number, value & 0xff, value >> 8, 0, 0, 0, 0});
  return transfer;
}

}  // namespace

Transfer purge_received() { return request(0, 1); }
Transfer purge_sent() { return request(0, 2); }
Transfer rts(bool high) { return request(1, high ? 0x0202 : 0x0200); }
Transfer dtr(bool high) { return request(1, high ? 0x0101 : 0x0100); }
Transfer no_flow_control() { return request(2, 0); }
Transfer baud_divisor(std::uint16_t divisor) { return request(3, divisor); }
Transfer eight_bits() { return request(4, 8); }
Transfer latency_ms(std::uint8_t milliseconds) { return request(9, milliseconds); }

Transfer bulk(std::vector<std::byte> bytes) {
  Transfer transfer;
  transfer.direction = Direction::to_device;
  transfer.kind = TransferKind::usb_bulk;
  transfer.endpoint = bulk_out;
  transfer.payload = std::move(bytes);
  return transfer;
}

std::vector<std::byte> without_status(Bytes transfer) {
  std::vector<std::byte> bytes;
  for (std::size_t at = 0; at < transfer.size(); at += packet_length) {
    const Bytes packet = transfer.subspan(at, std::min(packet_length, transfer.size() - at));
    if (packet.size() > status_length) append(bytes, packet.subspan(status_length));
  }
  return bytes;
}

}  // namespace fude::falcon
