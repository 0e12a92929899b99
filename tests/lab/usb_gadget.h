// A USB device of the kernel's own making: a gadget of configfs, plugged into the virtual host dummy_hcd.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace fude::lab {

struct UsbIdentity {
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
  std::string serial;
  std::string name;
};

// Throws std::system_error and std::filesystem::filesystem_error.
class UsbGadget {
 public:
  // `port` is one of the three that the virtual host has, counted from 0.
  UsbGadget(const UsbIdentity& identity, int port);
  ~UsbGadget();
  UsbGadget(const UsbGadget&) = delete;
  UsbGadget& operator=(const UsbGadget&) = delete;

  // A function by its kernel name ("ffs.lab"); before plug().
  void add(const std::string& function);
  std::filesystem::path function(const std::string& name) const { return folder_ / "functions" / name; }

  void plug();
  void unplug();

 private:
  std::filesystem::path folder_;
  std::string port_;
  std::vector<std::string> functions_;
  bool plugged_ = false;
};

}  // namespace fude::lab
