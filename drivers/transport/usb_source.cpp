#include "drivers/transport/usb_source.h"

#include <libusb.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <utility>

#include "drivers/transport/device_node.h"

namespace fude {
namespace {

constexpr unsigned patience_ms = 1000;
constexpr int in_flight = 4;  // of each endpoint: the host always has somewhere to put the next
constexpr int packets_of_bulk = 16;
constexpr Duration before_again = std::chrono::milliseconds(10);  // after a halt or an error

bool is_in(std::uint8_t address) { return (address & LIBUSB_ENDPOINT_DIR_MASK) == LIBUSB_ENDPOINT_IN; }

}  // namespace

// One transfer of an IN endpoint, submitted again each time it completes. All but the constructor runs on
// the serving thread.
class UsbSource::Pump {
 public:
  Pump(UsbSource& source, const libusb_endpoint_descriptor& endpoint)
      : source_(source),
        bulk_((endpoint.bmAttributes & LIBUSB_TRANSFER_TYPE_MASK) == LIBUSB_TRANSFER_TYPE_BULK),
        // The low eleven bits: above them a high-speed endpoint says how many packets a microframe may bring.
        buffer_(static_cast<std::size_t>(endpoint.wMaxPacketSize & 0x7ff) *
                static_cast<std::size_t>(bulk_ ? packets_of_bulk : 1 + (endpoint.wMaxPacketSize >> 11 & 3))),
        transfer_(libusb_alloc_transfer(0)) {
    libusb_fill_bulk_transfer(transfer_, source.handle_.get(), endpoint.bEndpointAddress, buffer_.data(),
                              static_cast<int>(buffer_.size()), &Pump::completed, this, 0);
    transfer_->type = bulk_ ? LIBUSB_TRANSFER_TYPE_BULK : LIBUSB_TRANSFER_TYPE_INTERRUPT;
  }
  ~Pump() { libusb_free_transfer(transfer_); }
  Pump(const Pump&) = delete;
  Pump& operator=(const Pump&) = delete;

  bool flying() const { return flying_; }
  void cancel() {
    if (flying_) libusb_cancel_transfer(transfer_);
  }

  // Submits where it lies idle and its pause is over.
  void tend(Timestamp now) {
    if (flying_ || now < again_) return;
    if (std::exchange(halted_, false)) libusb_clear_halt(source_.handle_.get(), transfer_->endpoint);
    const int status = libusb_submit_transfer(transfer_);
    flying_ = status == LIBUSB_SUCCESS;
    if (status == LIBUSB_ERROR_NO_DEVICE) source_.gone_ = true;
    if (!flying_) again_ = now + before_again;
  }

 private:
  static void LIBUSB_CALL completed(libusb_transfer* transfer) {
    static_cast<Pump*>(transfer->user_data)->complete();
  }

  void complete() {
    const Timestamp now = monotonic_now();
    flying_ = false;
    switch (transfer_->status) {
      case LIBUSB_TRANSFER_COMPLETED: {
        const auto bytes =
            std::as_bytes(std::span(buffer_)).first(static_cast<std::size_t>(transfer_->actual_length));
        source_.inbox_.put({now,
                            StampedBy::arrival,
                            Direction::from_device,
                            bulk_ ? TransferKind::usb_bulk : TransferKind::usb_interrupt,
                            {bytes.begin(), bytes.end()},
                            transfer_->endpoint});
        if (!source_.ending_) tend(now);
        return;
      }
      case LIBUSB_TRANSFER_NO_DEVICE:
        source_.gone_ = true;
        return;
      case LIBUSB_TRANSFER_CANCELLED:
        return;
      case LIBUSB_TRANSFER_STALL:
        ++source_.stalls_;
        halted_ = true;
        break;
      case LIBUSB_TRANSFER_OVERFLOW:
        ++source_.oversized_;
        break;
      default:
        ++source_.errors_;
        break;
    }
    again_ = now + before_again;
  }

  UsbSource& source_;
  bool bulk_;
  std::vector<unsigned char> buffer_;
  libusb_transfer* transfer_;
  bool flying_ = false;
  bool halted_ = false;
  Timestamp again_{};
};

void UsbSource::Close::operator()(libusb_context* context) const { libusb_exit(context); }
void UsbSource::Close::operator()(libusb_device_handle* handle) const { libusb_close(handle); }

Result<std::unique_ptr<UsbSource>> UsbSource::open(const std::filesystem::path& node,
                                                   const std::vector<std::uint8_t>& interfaces) {
  auto file = open_alone(node);
  if (!file) return tl::unexpected(file.error());
  // udev finds the devices; libusb is to look at this one alone.
  libusb_set_option(nullptr, LIBUSB_OPTION_NO_DEVICE_DISCOVERY);
  libusb_context* raw_context = nullptr;
  libusb_device_handle* raw_handle = nullptr;
  if (libusb_init(&raw_context) != LIBUSB_SUCCESS)
    return failure(Fault::unsupported, "libusb does not start");
  Context context(raw_context);
  if (libusb_wrap_sys_device(raw_context, file->get(), &raw_handle) != LIBUSB_SUCCESS)
    return failure(Fault::unsupported, node.string() + " is no USB device; name a /dev/bus/usb/…");
  std::unique_ptr<UsbSource> source(
      new UsbSource(std::move(*file), std::move(context), Handle(raw_handle), node));
  for (const std::uint8_t interface : interfaces)
    if (auto claimed = source->claim(interface); !claimed) return tl::unexpected(claimed.error());
  source->thread_ = std::thread(&UsbSource::serve, source.get());
  return source;
}

UsbSource::UsbSource(FileDescriptor file, Context context, Handle handle, std::filesystem::path node)
    : file_(std::move(file)),
      context_(std::move(context)),
      handle_(std::move(handle)),
      node_(std::move(node)) {}

UsbSource::~UsbSource() {
  ending_ = true;
  if (thread_.joinable()) {
    libusb_interrupt_event_handler(context_.get());
    thread_.join();
  }
  pumps_.clear();
  // Gives each interface back to the kernel driver that had it.
  for (const std::uint8_t interface : claimed_) libusb_release_interface(handle_.get(), interface);
}

Result<void> UsbSource::claim(std::uint8_t interface) {
  libusb_set_auto_detach_kernel_driver(handle_.get(), 1);
  const int status = libusb_claim_interface(handle_.get(), interface);
  const std::string name = node_.string() + ", interface " + std::to_string(interface) + ",";
  if (status == LIBUSB_ERROR_BUSY)
    return failure(Fault::busy, name + " is held by another program; end it first");
  if (status == LIBUSB_ERROR_NO_DEVICE) return failure(Fault::device_gone, node_.string() + " was unplugged");
  libusb_config_descriptor* config = nullptr;
  if (status != LIBUSB_SUCCESS ||
      libusb_get_active_config_descriptor(libusb_get_device(handle_.get()), &config) != LIBUSB_SUCCESS)
    return failure(Fault::not_found, name + " is not there (" + libusb_strerror(status) + ")");
  claimed_.push_back(interface);
  const std::unique_ptr<libusb_config_descriptor, decltype(&libusb_free_config_descriptor)> owned(
      config, libusb_free_config_descriptor);
  for (int i = 0; i < config->bNumInterfaces; ++i) {
    const libusb_interface_descriptor& plain = config->interface[i].altsetting[0];
    if (plain.bInterfaceNumber != interface) continue;
    for (int e = 0; e < plain.bNumEndpoints; ++e) {
      const libusb_endpoint_descriptor& endpoint = plain.endpoint[e];
      const int type = endpoint.bmAttributes & LIBUSB_TRANSFER_TYPE_MASK;
      if (!is_in(endpoint.bEndpointAddress) ||
          (type != LIBUSB_TRANSFER_TYPE_BULK && type != LIBUSB_TRANSFER_TYPE_INTERRUPT))
        continue;
      for (int n = 0; n < in_flight; ++n) pumps_.push_back(std::make_unique<Pump>(*this, endpoint));
    }
  }
  return {};
}

void UsbSource::serve() {
  const auto serve_once = [this](Duration patience) {
    timeval wait{0, static_cast<suseconds_t>(patience / std::chrono::microseconds(1))};
    libusb_handle_events_timeout(context_.get(), &wait);
  };
  while (!ending_ && !gone_) {
    bool idle = false;
    for (const auto& pump : pumps_) {
      pump->tend(monotonic_now());
      idle = idle || !pump->flying();
    }
    serve_once(idle ? before_again : std::chrono::milliseconds(500));
  }
  for (const auto& pump : pumps_) pump->cancel();
  const auto flying = [](const auto& pump) { return pump->flying(); };
  while (std::any_of(pumps_.begin(), pumps_.end(), flying)) serve_once(before_again);
  // Last of all: what the device had sent before may come to light after the first transfer has failed.
  if (gone_)
    inbox_.put({monotonic_now(), StampedBy::arrival, Direction::from_device, TransferKind::unplugged, {}});
}

Result<std::optional<Transfer>> UsbSource::read(std::optional<Timestamp> deadline) {
  for (;;) {
    if (auto transfer = inbox_.take()) {
      told_gone_ = told_gone_ || transfer->kind == TransferKind::unplugged;
      return transfer;
    }
    if (told_gone_) return failure(Fault::device_gone, node_.string() + " was unplugged; plug it in again");
    const Inbox::Outcome outcome = inbox_.wait(-1, deadline);
    if (outcome.woken || outcome.late) return inbox_.take();
  }
}

Result<void> UsbSource::outcome(int status, const char* what) {
  if (status >= 0) return {};
  if (status == LIBUSB_ERROR_NO_DEVICE) return failure(Fault::device_gone, node_.string() + " was unplugged");
  if (status == LIBUSB_ERROR_TIMEOUT)
    return failure(Fault::busy,
                   node_.string() + " does not answer " + what + "; unplug it and plug it in again");
  return failure(Fault::unsupported,
                 node_.string() + " refuses " + what + " (" + libusb_strerror(status) + ")");
}

Result<void> UsbSource::write(const Transfer& transfer) {
  if (transfer.kind == TransferKind::usb_control) return control(transfer);
  if (transfer.kind != TransferKind::usb_bulk && transfer.kind != TransferKind::usb_interrupt)
    return ByteSource::write(transfer);
  if (is_in(transfer.endpoint)) return failure(Fault::unsupported, "bytes are sent to an OUT endpoint");
  std::vector<std::byte> bytes = transfer.payload;
  const auto send =
      transfer.kind == TransferKind::usb_bulk ? libusb_bulk_transfer : libusb_interrupt_transfer;
  int sent = 0;
  const int status = send(handle_.get(), transfer.endpoint, reinterpret_cast<unsigned char*>(bytes.data()),
                          static_cast<int>(bytes.size()), &sent, patience_ms);
  if (status == LIBUSB_ERROR_PIPE) libusb_clear_halt(handle_.get(), transfer.endpoint);
  return outcome(status, "the transfer");
}

Result<void> UsbSource::control(const Transfer& transfer) {
  constexpr std::size_t setup_size = 8;
  if (transfer.payload.size() < setup_size)
    return failure(Fault::unsupported, "a control transfer begins with its setup packet of eight bytes");
  const auto at = [&](std::size_t i) { return std::to_integer<unsigned>(transfer.payload[i]); };
  const auto word = [&](std::size_t i) { return static_cast<std::uint16_t>(at(i) | at(i + 1) << 8); };
  const auto request_type = static_cast<std::uint8_t>(at(0));
  const std::uint16_t length = word(6);
  std::vector<std::byte> data(transfer.payload.begin() + setup_size, transfer.payload.end());
  const bool reads = is_in(request_type);
  if (reads) data.assign(length, std::byte{0});
  if (data.size() != length)
    return failure(Fault::unsupported, "the setup packet speaks of " + std::to_string(length) +
                                           " bytes, there are " + std::to_string(data.size()));
  const int status =
      libusb_control_transfer(handle_.get(), request_type, static_cast<std::uint8_t>(at(1)), word(2), word(4),
                              reinterpret_cast<unsigned char*>(data.data()), length, patience_ms);
  if (reads && (status >= 0 || status == LIBUSB_ERROR_PIPE)) {
    Transfer answer{monotonic_now(),
                    StampedBy::arrival,
                    Direction::from_device,
                    TransferKind::usb_control,
                    {transfer.payload.begin(), transfer.payload.begin() + setup_size}};
    answer.payload.insert(answer.payload.end(), data.begin(), data.begin() + std::max(status, 0));
    inbox_.put(std::move(answer));
  }
  return outcome(status, "the request");
}

}  // namespace fude
