#include "drivers/transport/serial_source.h"

#include <sys/ioctl.h>

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <string>
#include <utility>

#include "drivers/transport/device_node.h"

namespace fude {

void SerialSource::Close::operator()(sp_port* port) const {
  sp_close(port);
  sp_free_port(port);
}

Result<std::unique_ptr<SerialSource>> SerialSource::open(const std::filesystem::path& node, int baud) {
  sp_port* raw = nullptr;
  if (sp_get_port_by_name(node.c_str(), &raw) != SP_OK)
    return failure(Fault::not_found, node.string() + " is no serial port; is the device plugged in?");
  Port port(raw);
  if (sp_open(raw, SP_MODE_READ_WRITE) != SP_OK) {
    if (errno == EACCES || errno == EPERM) return failure(Fault::no_access, access_advice(node));
    if (errno == EBUSY)
      return failure(Fault::busy, node.string() + " is held by another program; end it first");
    return failure(Fault::not_found,
                   node.string() + ": " + std::strerror(errno) + "; is the device plugged in?");
  }
  int file = -1;
  sp_get_port_handle(raw, &file);
  if (auto held = hold_alone(file, node); !held) return tl::unexpected(held.error());
  ioctl(file, TIOCEXCL);  // keeps out those who look at no lock
  const bool set = sp_set_baudrate(raw, baud) == SP_OK && sp_set_bits(raw, 8) == SP_OK &&
                   sp_set_parity(raw, SP_PARITY_NONE) == SP_OK && sp_set_stopbits(raw, 1) == SP_OK &&
                   sp_set_flowcontrol(raw, SP_FLOWCONTROL_NONE) == SP_OK;
  if (!set)
    return failure(Fault::unsupported, node.string() + " does not go at " + std::to_string(baud) + " baud");
  return std::unique_ptr<SerialSource>(new SerialSource(std::move(port), file, node));
}

SerialSource::SerialSource(Port port, int file, std::filesystem::path node)
    : port_(std::move(port)), file_(file), node_(std::move(node)) {}

Result<std::optional<Transfer>> SerialSource::read(std::optional<Timestamp> deadline) {
  for (;;) {
    if (auto transfer = inbox_.take()) return transfer;
    if (gone_) return failure(Fault::device_gone, node_.string() + " was unplugged; plug it in again");
    const Inbox::Outcome outcome = inbox_.wait(file_, deadline);
    if (outcome.ready || outcome.gone) take_bytes(outcome.gone);
    if (outcome.woken || outcome.late) return inbox_.take();
  }
}

// A port that hung up reads as empty for ever, and poll() says so.
void SerialSource::take_bytes(bool hung_up) {
  std::array<std::byte, 4096> buffer;
  const int size = sp_nonblocking_read(port_.get(), buffer.data(), buffer.size());
  const Timestamp now = monotonic_now();
  if (size > 0) {
    inbox_.put({now,
                StampedBy::arrival,
                Direction::from_device,
                TransferKind::serial,
                {buffer.begin(), buffer.begin() + size}});
  } else if (hung_up || size < 0) {
    gone_ = true;
    inbox_.put({now, StampedBy::arrival, Direction::from_device, TransferKind::unplugged, {}});
  }
}

Result<void> SerialSource::write(const Transfer& transfer) {
  constexpr unsigned patience_ms = 1000;
  if (transfer.kind != TransferKind::serial) return ByteSource::write(transfer);
  const int size =
      sp_blocking_write(port_.get(), transfer.payload.data(), transfer.payload.size(), patience_ms);
  if (size < 0) return failure(Fault::device_gone, node_.string() + " was unplugged");
  if (static_cast<std::size_t>(size) < transfer.payload.size())
    return failure(Fault::busy, node_.string() + " takes no more bytes; is the device switched on?");
  return {};
}

}  // namespace fude
