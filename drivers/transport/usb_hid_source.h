// A HID device that the kernel's HID driver leaves alone, spoken to over libusb.
#pragma once

#include <memory>

#include "drivers/transport/usb_source.h"

namespace fude {

// Looks like a HidrawSource: input reports come as hid_report; hid_feature and hid_ask become the class
// requests SET_REPORT and GET_REPORT (HID 1.11, 7.2) to the interface.
class UsbHidSource final : public ByteSource {
 public:
  // `numbered`: each report begins with its number. Errors: as UsbSource::open().
  static Result<std::unique_ptr<UsbHidSource>> open(const std::filesystem::path& node, std::uint8_t interface,
                                                    bool numbered);

  Result<std::optional<Transfer>> read(std::optional<Timestamp> deadline) override;

  // hid_report (as an output report), hid_feature and hid_ask. Errors: as UsbSource::write().
  Result<void> write(const Transfer& transfer) override;
  void wake() override { usb_->wake(); }

 private:
  UsbHidSource(std::unique_ptr<UsbSource> usb, std::uint8_t interface, bool numbered)
      : usb_(std::move(usb)), interface_(interface), numbered_(numbered) {}

  std::unique_ptr<UsbSource> usb_;
  std::uint8_t interface_;
  bool numbered_;
};

}  // namespace fude
