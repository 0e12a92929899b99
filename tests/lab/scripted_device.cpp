#include "tests/lab/scripted_device.h"

#include <fcntl.h>
#include <linux/usb/functionfs.h>
#include <sys/mount.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

namespace fude::lab {
namespace {

[[noreturn]] void fail(const std::string& what) {
  throw std::system_error(errno, std::generic_category(), what);
}

void put(Bytes& to, std::uint32_t value, int width) {
  for (int i = 0; i < width; ++i) to.push_back(static_cast<std::byte>(value >> (8 * i)));
}

// The interface's descriptors as USB 2.0, 9.6 and HID 1.11, 6.2.1 lay them out; returns how many.
std::uint32_t lay_out(const ScriptedInterface& interface, bool high_speed, Bytes& to) {
  std::uint32_t count = 1;
  const auto endpoints = static_cast<std::uint32_t>(interface.endpoints.size());
  const std::uint32_t usb_class = interface.usb_class, subclass = interface.subclass,
                      protocol = interface.protocol;
  for (const std::uint32_t byte : {9u, 4u, 0u, 0u, endpoints, usb_class, subclass, protocol, 1u})
    put(to, byte, 1);
  // The kernel's cdc-acm refuses an interface with nothing behind it, and FunctionFS knows no descriptors of
  // its class: the association of the interface with itself is one that both let pass.
  if (usb_class == USB_CLASS_COMM) {
    ++count;
    for (const std::uint32_t byte : {8u, 0x0bu, 0u, 1u, usb_class, subclass, protocol, 0u}) put(to, byte, 1);
  }
  if (!interface.hid_descriptor.empty()) {
    ++count;
    for (const std::uint32_t byte : {9u, 0x21u, 0x11u, 0x01u, 0u, 1u, 0x22u}) put(to, byte, 1);
    put(to, static_cast<std::uint32_t>(interface.hid_descriptor.size()), 2);
  }
  constexpr std::uint32_t bulk_at_high_speed = 512;  // fixed by USB 2.0, 5.8.3
  for (const ScriptedEndpoint& endpoint : interface.endpoints) {
    ++count;
    put(to, 7, 1);
    put(to, 5, 1);
    put(to, endpoint.address, 1);
    put(to, endpoint.bulk ? 2 : 3, 1);
    put(to, high_speed && endpoint.bulk ? bulk_at_high_speed : endpoint.packet, 2);
    put(to, endpoint.bulk ? 0 : 1, 1);
  }
  return count;
}

}  // namespace

ScriptedDevice::ScriptedDevice(const UsbIdentity& identity, int port, const ScriptedInterface& interface,
                               Answer answer)
    : name_("lab" + std::to_string(port)),
      interface_(interface),
      answer_(std::move(answer)),
      gadget_(identity, port) {
  gadget_.add("ffs." + name_);
  const std::filesystem::path folder = "/dev/ffs-" + name_;
  std::filesystem::create_directory(folder);
  if (mount(name_.c_str(), folder.c_str(), "functionfs", 0, nullptr) != 0) fail("functionfs");
  control_ = FileDescriptor(open((folder / "ep0").c_str(), O_RDWR | O_CLOEXEC));
  if (control_.get() < 0) fail("ep0");
  describe();
  int number = 0;
  for (const ScriptedEndpoint& endpoint : interface_.endpoints) {
    const auto file = folder / ("ep" + std::to_string(++number));
    endpoints_[endpoint.address] = FileDescriptor(open(file.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC));
    if (endpoints_[endpoint.address].get() < 0) fail(file);
  }
  thread_ = std::thread(&ScriptedDevice::serve, this);
  plug();
}

ScriptedDevice::~ScriptedDevice() {
  try {
    unplug();
  } catch (const std::system_error&) {
  }
  waker_.wake();
  thread_.join();
  endpoints_.clear();
  control_ = {};
  umount2(("/dev/ffs-" + name_).c_str(), MNT_DETACH);
}

void ScriptedDevice::describe() {
  Bytes both;
  const std::uint32_t full = lay_out(interface_, false, both);
  const std::uint32_t high = lay_out(interface_, true, both);
  Bytes head;
  put(head, FUNCTIONFS_DESCRIPTORS_MAGIC_V2, 4);
  put(head, static_cast<std::uint32_t>(20 + both.size()), 4);
  put(head, FUNCTIONFS_HAS_FS_DESC | FUNCTIONFS_HAS_HS_DESC | FUNCTIONFS_ALL_CTRL_RECIP, 4);
  put(head, full, 4);
  put(head, high, 4);
  head.insert(head.end(), both.begin(), both.end());
  Bytes strings;
  put(strings, FUNCTIONFS_STRINGS_MAGIC, 4);
  put(strings, 16 + 2 + 4, 4);
  put(strings, 1, 4);
  put(strings, 1, 4);
  put(strings, 0x409, 2);
  put(strings, 'l' | 'a' << 8 | 'b' << 16, 4);
  for (const Bytes& part : {head, strings})
    if (write(control_.get(), part.data(), part.size()) < 0) fail("descriptors");
}

void ScriptedDevice::serve() {
  for (;;) {
    const Waker::Outcome outcome = waker_.wait(control_.get(), std::nullopt);
    if (outcome.woken) return;
    usb_functionfs_event event{};
    if (read(control_.get(), &event, sizeof event) != static_cast<ssize_t>(sizeof event)) continue;
    if (event.type != FUNCTIONFS_SETUP) continue;
    const usb_ctrlrequest& setup = event.u.setup;
    ScriptedRequest request{setup.bRequestType, setup.bRequest, setup.wValue, setup.wIndex, {}};
    const std::uint16_t length = setup.wLength;
    if ((request.type & USB_DIR_IN) == 0 && length > 0) {
      request.data.resize(length);
      if (read(control_.get(), request.data.data(), length) < 0) continue;
    }
    answer(request, length);
  }
}

void ScriptedDevice::answer(const ScriptedRequest& request, std::uint16_t length) {
  constexpr std::uint16_t report_descriptor = 0x2200;
  const bool to_host = (request.type & USB_DIR_IN) != 0;
  std::optional<Bytes> reply;
  if (request.type == 0x81 && request.request == USB_REQ_GET_DESCRIPTOR && request.value == report_descriptor)
    reply = interface_.hid_descriptor;
  else if (answer_)
    reply = answer_(request);
  Bytes none;
  if (to_host && reply) {
    reply->resize(std::min<std::size_t>(reply->size(), length));
    if (write(control_.get(), reply->data(), reply->size()) < 0) return;  // the host has given up
  } else if (!reply && (to_host || length == 0)) {
    // The wrong direction is how FunctionFS is told to stall.
    if (to_host ? read(control_.get(), none.data(), 0) < 0 : write(control_.get(), none.data(), 0) < 0)
      return;
  } else if (!to_host && length == 0) {
    if (read(control_.get(), none.data(), 0) < 0) return;
  }
}

// An endpoint that the host has not set up (yet, or any more) says EAGAIN; one under way waits for the host.
ssize_t ScriptedDevice::patiently(const std::function<ssize_t()>& transfer) {
  for (;;) {
    const ssize_t size = transfer();
    if (size >= 0 || errno != EAGAIN || !plugged_) return size;
    usleep(500);
  }
}

bool ScriptedDevice::send(std::uint8_t address, const Bytes& bytes) {
  const int file = endpoints_.at(address).get();
  return patiently([&] { return write(file, bytes.data(), bytes.size()); }) >= 0;
}

std::optional<Bytes> ScriptedDevice::receive(std::uint8_t address) {
  Bytes bytes(4096);
  const int file = endpoints_.at(address).get();
  const ssize_t size = patiently([&] { return read(file, bytes.data(), bytes.size()); });
  if (size < 0) return std::nullopt;
  bytes.resize(static_cast<std::size_t>(size));
  return bytes;
}

void ScriptedDevice::plug() {
  plugged_ = true;
  gadget_.plug();
}

void ScriptedDevice::unplug() {
  plugged_ = false;
  gadget_.unplug();
}

void ScriptedDevice::stall(std::uint8_t address) {
  std::byte nothing{};
  const int file = endpoints_.at(address).get();
  // Reading from an endpoint that writes (or the other way about) halts it and says EBADMSG.
  const ssize_t status = patiently(
      [&] { return (address & USB_DIR_IN) != 0 ? read(file, &nothing, 1) : write(file, &nothing, 1); });
  if (status >= 0 || errno != EBADMSG) fail("stall");
}

}  // namespace fude::lab
