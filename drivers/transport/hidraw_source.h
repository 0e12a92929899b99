// A HID device, read and written report by report through the kernel's hidraw.
//
// Straight on the kernel's interface rather than by hidapi: that keeps its file to itself, so a wait for a
// report can only be ended by polling; before 0.14 it does not give the report descriptor, and it turns
// every error into one.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "drivers/transport/file_descriptor.h"
#include "drivers/transport/inbox.h"
#include "signal/byte_source.h"

namespace fude {

class HidrawSource final : public ByteSource {
 public:
  // Opens e.g. /dev/hidraw3, for this program alone. Errors: see open_alone(); unsupported for a node that
  // is no HID device.
  static Result<std::unique_ptr<HidrawSource>> open(const std::filesystem::path& node);

  // The HID report descriptor, as the device gave it.
  std::span<const std::byte> report_descriptor() const { return descriptor_; }

  // Reports are stamped on arrival. The kernel keeps 64 unread ones and silently drops what comes then, so
  // only a sequence number of the device's own can tell.
  Result<std::optional<Transfer>> read(std::optional<Timestamp> deadline) override;

  // hid_report, hid_feature and hid_ask; the answer to hid_ask (a hid_feature) comes through read(). May be
  // called while another thread reads. Errors: unsupported when the device refuses the report.
  Result<void> write(const Transfer& transfer) override;
  void wake() override { inbox_.wake(); }

 private:
  HidrawSource(FileDescriptor file, std::filesystem::path node, std::vector<std::byte> descriptor);

  Result<void> ask(std::byte number);
  void take_report();
  void unplugged();

  FileDescriptor file_;
  std::filesystem::path node_;
  std::vector<std::byte> descriptor_;
  bool numbered_;  // reports carry a number; where they do not, it is 0 on our side of the kernel alone
  Inbox inbox_;
  bool gone_ = false;
};

}  // namespace fude
