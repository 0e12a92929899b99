#include "drivers/transport/usb_hid_source.h"

#include <cstddef>
#include <utility>
#include <vector>

namespace fude {
namespace {

constexpr std::size_t setup_size = 8;
constexpr std::uint8_t to_interface = 0x21;  // class request
constexpr std::uint8_t from_interface = 0xa1;
constexpr std::uint8_t get_report = 0x01;
constexpr std::uint8_t set_report = 0x09;
constexpr std::uint8_t output = 2;
constexpr std::uint8_t feature = 3;
constexpr std::size_t longest_answer = 4096;

Transfer request(std::uint8_t type, std::uint8_t code, std::uint8_t report_type, std::byte number,
                 std::uint8_t interface, std::size_t length) {
  Transfer transfer;
  transfer.direction = Direction::to_device;
  transfer.kind = TransferKind::usb_control;
  transfer.payload = {std::byte{type},
                      std::byte{code},
                      number,
                      std::byte{report_type},
                      std::byte{interface},
                      std::byte{0},
                      static_cast<std::byte>(length),
                      static_cast<std::byte>(length >> 8)};
  return transfer;
}

}  // namespace

Result<std::unique_ptr<UsbHidSource>> UsbHidSource::open(const std::filesystem::path& node,
                                                         std::uint8_t interface, bool numbered) {
  auto usb = UsbSource::open(node, {interface});
  if (!usb) return tl::unexpected(usb.error());
  return std::unique_ptr<UsbHidSource>(new UsbHidSource(std::move(*usb), interface, numbered));
}

Result<std::optional<Transfer>> UsbHidSource::read(std::optional<Timestamp> deadline) {
  auto got = usb_->read(deadline);
  if (!got || !*got) return got;
  Transfer& transfer = **got;
  std::vector<std::byte>& bytes = transfer.payload;
  if (transfer.kind == TransferKind::usb_interrupt) {
    transfer.kind = TransferKind::hid_report;
    if (!numbered_) bytes.insert(bytes.begin(), std::byte{0});
  } else if (transfer.kind == TransferKind::usb_control) {
    transfer.kind = TransferKind::hid_feature;
    const std::byte number = bytes.at(2);
    bytes.erase(bytes.begin(), bytes.begin() + setup_size);
    if (bytes.empty()) return std::nullopt;  // refused: whoever wrote has been told
    if (!numbered_) bytes.insert(bytes.begin(), number);
  }
  transfer.endpoint = 0;
  return got;
}

Result<void> UsbHidSource::write(const Transfer& transfer) {
  if (transfer.payload.empty()) return failure(Fault::unsupported, "a HID report has at least its number");
  const std::byte number = transfer.payload.front();
  if (transfer.kind == TransferKind::hid_ask)
    return usb_->write(request(from_interface, get_report, feature, number, interface_, longest_answer));
  if (transfer.kind != TransferKind::hid_feature && transfer.kind != TransferKind::hid_report)
    return ByteSource::write(transfer);
  const auto first = transfer.payload.begin() + (numbered_ ? 0 : 1);
  Transfer sent =
      request(to_interface, set_report, transfer.kind == TransferKind::hid_feature ? feature : output, number,
              interface_, static_cast<std::size_t>(transfer.payload.end() - first));
  sent.payload.insert(sent.payload.end(), first, transfer.payload.end());
  return usb_->write(sent);
}

}  // namespace fude
