// A USB device, read and written through libusb.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

#include "drivers/transport/file_descriptor.h"
#include "drivers/transport/inbox.h"
#include "signal/byte_source.h"

struct libusb_context;
struct libusb_device_handle;

namespace fude {

// What went wrong on the way and was tried again; what it cost is not known.
struct UsbFaults {
  std::uint64_t stalls = 0;     // the device halted an endpoint; cleared
  std::uint64_t oversized = 0;  // the device sent more than the endpoint's packet holds; not delivered
  std::uint64_t errors = 0;     // the transfer broke on the wire
};

class UsbSource final : public ByteSource {
 public:
  // Opens e.g. /dev/bus/usb/001/004 for this program alone, takes `interfaces` from whatever kernel driver
  // has them, and from then on listens to all their interrupt and bulk IN endpoints, several transfers of
  // each in flight, whether or not anybody reads. Errors: see open_alone(); busy also when another program
  // has an interface; not_found for an interface that is not there.
  static Result<std::unique_ptr<UsbSource>> open(const std::filesystem::path& node,
                                                 const std::vector<std::uint8_t>& interfaces);
  ~UsbSource() override;

  // usb_interrupt and usb_bulk as they completed, stamped on arrival by the thread that serves libusb.
  // A bulk transfer ends with a short packet or when 16 packets are full.
  Result<std::optional<Transfer>> read(std::optional<Timestamp> deadline) override;

  // usb_bulk and usb_interrupt to an OUT endpoint, and usb_control, whose first eight bytes are the setup
  // packet. Returns when the device has taken it. What a control transfer reads comes through read(), setup
  // packet first; nothing after that packet when the device has refused. Not from several threads at once.
  // Errors: device_gone; busy when the device did not answer within a second; unsupported when it refuses.
  Result<void> write(const Transfer& transfer) override;
  void wake() override { inbox_.wake(); }

  UsbFaults faults() const { return {stalls_, oversized_, errors_}; }

 private:
  class Pump;
  struct Close {
    void operator()(libusb_context* context) const;
    void operator()(libusb_device_handle* handle) const;
  };
  using Context = std::unique_ptr<libusb_context, Close>;
  using Handle = std::unique_ptr<libusb_device_handle, Close>;

  UsbSource(FileDescriptor file, Context context, Handle handle, std::filesystem::path node);

  Result<void> claim(std::uint8_t interface);
  Result<void> control(const Transfer& transfer);
  Result<void> outcome(int status, const char* what);
  void serve();

  FileDescriptor file_;
  Context context_;
  Handle handle_;
  std::filesystem::path node_;
  Inbox inbox_;
  std::vector<std::uint8_t> claimed_;
  std::vector<std::unique_ptr<Pump>> pumps_;
  std::atomic<bool> ending_ = false;
  std::atomic<bool> gone_ = false;  // known to the serving thread
  bool told_gone_ = false;          // and to the reader
  std::atomic<std::uint64_t> stalls_ = 0;
  std::atomic<std::uint64_t> oversized_ = 0;
  std::atomic<std::uint64_t> errors_ = 0;
  std::thread thread_;
};

}  // namespace fude
