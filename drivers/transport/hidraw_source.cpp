#include "drivers/transport/hidraw_source.h"

#include <linux/hidraw.h>
#include <sys/ioctl.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>

#include "drivers/transport/device_node.h"
#include "drivers/transport/hid_descriptor.h"

namespace fude {
namespace {

// A descriptor that does not parse is one that the kernel would not have bound.
bool has_report_numbers(std::span<const std::byte> descriptor) {
  const auto parsed = hid::parse_descriptor(descriptor);
  return parsed && parsed->numbered;
}

bool says_gone(int error) { return error == ENODEV || error == EIO || error == ESHUTDOWN; }

}  // namespace

Result<std::unique_ptr<HidrawSource>> HidrawSource::open(const std::filesystem::path& node) {
  auto file = open_alone(node);
  if (!file) return tl::unexpected(file.error());
  int size = 0;
  hidraw_report_descriptor descriptor{};
  const bool sized =
      ioctl(file->get(), HIDIOCGRDESCSIZE, &size) == 0 && size > 0 && size <= HID_MAX_DESCRIPTOR_SIZE;
  descriptor.size = static_cast<__u32>(size);
  if (!sized || ioctl(file->get(), HIDIOCGRDESC, &descriptor) != 0)
    return failure(Fault::unsupported, node.string() + " is no HID device; name a /dev/hidraw…");
  const auto bytes = std::as_bytes(std::span(descriptor.value)).first(descriptor.size);
  return std::unique_ptr<HidrawSource>(
      new HidrawSource(std::move(*file), node, std::vector<std::byte>(bytes.begin(), bytes.end())));
}

HidrawSource::HidrawSource(FileDescriptor file, std::filesystem::path node, std::vector<std::byte> descriptor)
    : file_(std::move(file)),
      node_(std::move(node)),
      descriptor_(std::move(descriptor)),
      numbered_(has_report_numbers(descriptor_)) {}

Result<std::optional<Transfer>> HidrawSource::read(std::optional<Timestamp> deadline) {
  for (;;) {
    if (auto transfer = inbox_.take()) return transfer;
    if (gone_) return failure(Fault::device_gone, node_.string() + " was unplugged; plug it in again");
    const Inbox::Outcome outcome = inbox_.wait(file_.get(), deadline);
    if (outcome.ready || outcome.gone) take_report();
    if (outcome.woken || outcome.late) return inbox_.take();
  }
}

void HidrawSource::take_report() {
  std::array<std::byte, HID_MAX_DESCRIPTOR_SIZE> buffer;
  const ssize_t size = ::read(file_.get(), buffer.data(), buffer.size());
  if (size <= 0) {
    if (size == 0 || (errno != EAGAIN && errno != EINTR)) unplugged();
    return;
  }
  Transfer report{monotonic_now(), StampedBy::arrival, Direction::from_device, TransferKind::hid_report, {}};
  if (!numbered_) report.payload.push_back(std::byte{0});
  report.payload.insert(report.payload.end(), buffer.begin(), buffer.begin() + size);
  inbox_.put(std::move(report));
}

Result<void> HidrawSource::write(const Transfer& transfer) {
  std::vector<std::byte> bytes = transfer.payload;
  if (bytes.empty()) return failure(Fault::unsupported, "a HID report has at least its number");
  int status = -1;
  if (transfer.kind == TransferKind::hid_ask) return ask(bytes.front());
  if (transfer.kind == TransferKind::hid_report)
    status = static_cast<int>(::write(file_.get(), bytes.data(), bytes.size()));
  else if (transfer.kind == TransferKind::hid_feature)
    status = ioctl(file_.get(), HIDIOCSFEATURE(bytes.size()), bytes.data());
  else
    return ByteSource::write(transfer);
  if (status >= 0) return {};
  if (says_gone(errno)) return failure(Fault::device_gone, node_.string() + " was unplugged");
  return failure(Fault::unsupported, node_.string() + " refuses report " +
                                         std::to_string(std::to_integer<int>(bytes.front())) + ": " +
                                         std::strerror(errno));
}

Result<void> HidrawSource::ask(std::byte number) {
  std::vector<std::byte> answer(HID_MAX_DESCRIPTOR_SIZE);
  answer.front() = number;
  const int size = ioctl(file_.get(), HIDIOCGFEATURE(answer.size()), answer.data());
  if (size < 0) {
    if (errno == ENODEV || errno == ESHUTDOWN)
      return failure(Fault::device_gone, node_.string() + " was unplugged");
    return failure(Fault::unsupported, node_.string() + " refuses feature report " +
                                           std::to_string(std::to_integer<int>(number)) + ": " +
                                           std::strerror(errno));
  }
  answer.resize(static_cast<std::size_t>(size));
  inbox_.put({monotonic_now(), StampedBy::arrival, Direction::from_device, TransferKind::hid_feature,
              std::move(answer)});
  return {};
}

void HidrawSource::unplugged() {
  gone_ = true;
  inbox_.put({monotonic_now(), StampedBy::arrival, Direction::from_device, TransferKind::unplugged, {}});
}

}  // namespace fude
