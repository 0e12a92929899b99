#include "tests/lab/usb_gadget.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <system_error>

#include "drivers/transport/file_descriptor.h"

namespace fude::lab {
namespace {

namespace fs = std::filesystem;

void put(const fs::path& file, const std::string& text) {
  const FileDescriptor open_file(open(file.c_str(), O_WRONLY | O_CLOEXEC));
  if (open_file.get() < 0 || write(open_file.get(), text.data(), text.size()) < 0)
    throw std::system_error(errno, std::generic_category(), file.string());
}

std::string hexadecimal(std::uint16_t number) {
  char digits[8];
  std::snprintf(digits, sizeof digits, "0x%04x", unsigned{number});
  return digits;
}

}  // namespace

UsbGadget::UsbGadget(const UsbIdentity& identity, int port)
    : folder_("/sys/kernel/config/usb_gadget/lab" + std::to_string(port)),
      port_("dummy_udc." + std::to_string(port)) {
  fs::create_directory(folder_);
  put(folder_ / "idVendor", hexadecimal(identity.vendor));
  put(folder_ / "idProduct", hexadecimal(identity.product));
  fs::create_directory(folder_ / "strings/0x409");
  put(folder_ / "strings/0x409/serialnumber", identity.serial);
  put(folder_ / "strings/0x409/product", identity.name);
  fs::create_directory(folder_ / "configs/lab.1");
}

// configfs wants everything taken apart in the order in which it was put together, backwards.
UsbGadget::~UsbGadget() {
  std::error_code ignored;
  try {
    unplug();
  } catch (const std::system_error&) {
  }
  for (const std::string& name : functions_) {
    fs::remove(folder_ / "configs/lab.1" / name, ignored);
    fs::remove(function(name), ignored);
  }
  for (const char* part : {"configs/lab.1", "strings/0x409", ""}) rmdir((folder_ / part).c_str());
}

void UsbGadget::add(const std::string& name) {
  fs::create_directory(function(name));
  fs::create_symlink(function(name), folder_ / "configs/lab.1" / name);
  functions_.push_back(name);
}

void UsbGadget::plug() {
  put(folder_ / "UDC", port_);
  plugged_ = true;
}

void UsbGadget::unplug() {
  if (plugged_) put(folder_ / "UDC", "\n");
  plugged_ = false;
}

}  // namespace fude::lab
