#include "tests/fakes/mock_tablet.h"

#include <fcntl.h>
#include <linux/input.h>
#include <umockdev.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <utility>

namespace fude {
namespace {

using Bytes = std::vector<unsigned char>;

std::string hexadecimal(const Bytes& bytes) {
  std::string digits;
  char two[3];
  for (unsigned char byte : bytes) {
    std::snprintf(two, sizeof two, "%02X", unsigned{byte});
    digits += two;
  }
  return digits;
}

void set_bit(Bytes& mask, unsigned bit) {
  mask.at(bit / 8) = static_cast<unsigned char>(mask.at(bit / 8) | 1u << bit % 8);
}

Bytes key_mask(const std::vector<std::uint16_t>& keys) {
  Bytes mask(KEY_CNT / 8);
  for (std::uint16_t key : keys) set_bit(mask, key);
  return mask;
}

Bytes abs_mask(const DeviceDescription& device) {
  Bytes mask(ABS_CNT / 8);
  for (const AxisRange& axis : device.axes) set_bit(mask, axis.code);
  return mask;
}

// The kernel's answers in umockdev's format: request, returned value, bytes.
std::string ioctl_answers(const DeviceDescription& device, const std::string& node,
                          const std::vector<std::uint16_t>& held) {
  std::string text = "@DEV " + node + "\n";
  const auto answer = [&](const std::string& request, std::size_t value, const Bytes& bytes) {
    text += request + " " + std::to_string(value) + " " + hexadecimal(bytes) + "\n";
  };
  const auto name = [&](const std::string& request, const std::string& value) {
    Bytes bytes(value.begin(), value.end());
    bytes.resize(255);
    answer(request, value.size() + 1, bytes);
  };
  Bytes types(8);
  for (unsigned type : {EV_SYN, EV_KEY, EV_ABS, EV_MSC}) set_bit(types, type);
  answer("EVIOCGBIT(0)", 8, types);
  name("EVIOCGNAME(0)", device.name);
  name("EVIOCGPHYS(0)", "usb-mock/input0");
  name("EVIOCGUNIQ(0)", device.serial);
  input_id id{device.bus, device.vendor, device.product, device.version};
  Bytes id_bytes(sizeof id);
  std::memcpy(id_bytes.data(), &id, sizeof id);
  answer("EVIOCGID", 0, id_bytes);
  answer("EVIOCGVERSION", 0, {1, 0, 1, 0});
  Bytes properties(8);
  for (std::uint16_t property : device.properties) set_bit(properties, property);
  answer("EVIOCGPROP(0)", 8, properties);
  answer("EVIOCGBIT(1)", KEY_CNT / 8, key_mask(device.keys));
  answer("EVIOCGBIT(2)", 8, Bytes(8));
  answer("EVIOCGBIT(3)", 8, abs_mask(device));
  Bytes serial(8);
  set_bit(serial, MSC_SERIAL);
  answer("EVIOCGBIT(4)", 8, serial);
  answer("EVIOCGBIT(5)", 8, Bytes(8));
  answer("EVIOCGBIT(17)", 8, Bytes(8));
  answer("EVIOCGBIT(18)", 8, Bytes(8));
  answer("EVIOCGBIT(21)", 16, Bytes(16));
  answer("EVIOCGKEY(0)", KEY_CNT / 8, key_mask(held));
  answer("EVIOCGLED(0)", 8, Bytes(8));
  answer("EVIOCGSW(0)", 8, Bytes(8));
  for (const AxisRange& axis : device.axes) {
    const input_absinfo state{axis.value, axis.minimum, axis.maximum, axis.fuzz, axis.flat, axis.resolution};
    Bytes bytes(sizeof state);
    std::memcpy(bytes.data(), &state, sizeof state);
    answer(axis.code == 0 ? "EVIOCGABS" : "EVIOCGABS(" + std::to_string(axis.code) + ")", 0, bytes);
  }
  return text;
}

void check(gboolean done, GError* error, const char* what) {
  if (!done) throw std::runtime_error(std::string(what) + ": " + (error != nullptr ? error->message : "?"));
}

// As sysfs prints a mask: words of 64 bits, the highest first.
std::string words(const Bytes& mask) {
  std::string text;
  char word[24];
  for (std::size_t at = mask.size(); at > 0; at -= 8) {
    std::uint64_t value = 0;
    std::memcpy(&value, &mask[at - 8], 8);
    std::snprintf(word, sizeof word, "%llx ", static_cast<unsigned long long>(value));
    text += word;
  }
  text.pop_back();
  return text;
}

std::string four_digits(std::uint16_t number) {
  char text[8];
  std::snprintf(text, sizeof text, "%04x", unsigned{number});
  return text;
}

}  // namespace

MockTablet::MockTablet(UMockdevTestbed* testbed, const DeviceDescription& device, int number,
                       const std::vector<std::uint16_t>& held)
    : testbed_(testbed) {
  const std::string event = "event" + std::to_string(number);
  node_ = "/dev/input/" + event;
  const std::string input = "/devices/mock/input/input" + std::to_string(number);
  syspath_ = "/sys" + input + "/" + event;
  // The parent first: who is told of the node looks there who it is.
  const std::string entry =
      "P: " + input + "\nE: SUBSYSTEM=input\nA: name=" + device.name + "\nA: uniq=" + device.serial +
      "\nA: id/bustype=" + four_digits(device.bus) + "\nA: id/vendor=" + four_digits(device.vendor) +
      "\nA: id/product=" + four_digits(device.product) + "\nA: id/version=" + four_digits(device.version) +
      "\nA: capabilities/key=" + words(key_mask(device.keys)) +
      "\nA: capabilities/abs=" + words(abs_mask(device)) + "\n\nP: " + input + "/" + event + "\nN: input/" +
      event + "\nE: DEVNAME=/dev/input/" + event +
      "\nE: SUBSYSTEM=input\nE: ID_SERIAL_SHORT=" + "FROMUDEV\nA: dev=13:" + std::to_string(64 + number) +
      "\n\n";
  GError* error = nullptr;
  const std::filesystem::path answers =
      std::filesystem::temp_directory_path() / ("fude-ioctl-" + std::to_string(getpid()));
  std::ofstream(answers) << ioctl_answers(device, node_, held);
  check(umockdev_testbed_load_ioctl(testbed, node_.c_str(), answers.c_str(), &error), error, "load_ioctl");
  std::filesystem::remove(answers);
  // Last, for it is told at once, and who opens the node then asks.
  check(umockdev_testbed_add_from_string(testbed, entry.c_str(), &error), error, "add_from_string");
  port_ = umockdev_testbed_get_dev_fd(testbed, node_.c_str());
}

void MockTablet::send(std::span<const EvdevEvent> events) {
  for (const EvdevEvent& event : events) {
    input_event raw{};
    raw.type = event.type;
    raw.code = event.code;
    raw.value = event.value;
    send_bytes(std::as_bytes(std::span(&raw, 1)));
  }
}

void MockTablet::send_bytes(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = write(port_, bytes.data(), bytes.size());
    if (written < 0 && errno == EAGAIN) {
      usleep(200);
      continue;
    }
    if (written < 0) throw std::runtime_error(std::string("write: ") + std::strerror(errno));
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
}

void MockTablet::hang_up() {
  const int nothing = open("/dev/null", O_RDWR | O_CLOEXEC);
  dup2(nothing, port_);  // the number is the testbed's to close
  close(nothing);
}

void MockTablet::announce_removal() { umockdev_testbed_uevent(testbed_, syspath_.c_str(), "remove"); }

}  // namespace fude
