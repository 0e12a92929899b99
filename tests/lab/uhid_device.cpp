#include "tests/lab/uhid_device.h"

#include <fcntl.h>
#include <linux/input.h>
#include <linux/uhid.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <system_error>

namespace fude::lab {
namespace {

void put(int file, const uhid_event& event) {
  if (write(file, &event, sizeof event) != static_cast<ssize_t>(sizeof event))
    throw std::system_error(errno, std::generic_category(), "uhid");
}

template <std::size_t N>
void copy_text(__u8 (&to)[N], const std::string& text) {
  std::memcpy(to, text.data(), std::min(text.size(), N - 1));
}

template <class Payload>
Bytes bytes_of(const Payload& from, std::size_t size) {
  const auto all = std::as_bytes(std::span(from));
  return {all.begin(), all.begin() + static_cast<std::ptrdiff_t>(std::min(size, all.size()))};
}

}  // namespace

UhidDevice::UhidDevice(const HidIdentity& identity, std::span<const std::byte> descriptor)
    : file_(open("/dev/uhid", O_RDWR | O_CLOEXEC)) {
  if (file_.get() < 0) throw std::system_error(errno, std::generic_category(), "/dev/uhid");
  uhid_event event{};
  event.type = UHID_CREATE2;
  uhid_create2_req& create = event.u.create2;
  copy_text(create.name, identity.name);
  copy_text(create.uniq, identity.serial);
  copy_text(create.phys, "lab/" + identity.serial);
  if (descriptor.size() > sizeof create.rd_data) throw std::length_error("report descriptor");
  std::memcpy(create.rd_data, descriptor.data(), descriptor.size());
  create.rd_size = static_cast<__u16>(descriptor.size());
  create.bus = BUS_USB;
  create.vendor = identity.vendor;
  create.product = identity.product;
  put(file_.get(), event);
  thread_ = std::thread(&UhidDevice::answer, this);
}

UhidDevice::~UhidDevice() {
  waker_.wake();
  thread_.join();
}

void UhidDevice::send(std::span<const std::byte> report) {
  uhid_event event{};
  event.type = UHID_INPUT2;
  if (report.size() > sizeof event.u.input2.data) throw std::length_error("report");
  event.u.input2.size = static_cast<__u16>(report.size());
  std::memcpy(event.u.input2.data, report.data(), report.size());
  put(file_.get(), event);
}

void UhidDevice::set_feature(Bytes report) {
  const std::lock_guard lock(mutex_);
  features_[std::to_integer<std::uint8_t>(report.at(0))] = std::move(report);
}

Bytes UhidDevice::feature(std::uint8_t number) {
  const std::lock_guard lock(mutex_);
  return features_[number];
}

std::vector<Bytes> UhidDevice::outputs() {
  const std::lock_guard lock(mutex_);
  return outputs_;
}

// The kernel's drivers ask while they bind and wait seconds for each answer that does not come.
void UhidDevice::answer() {
  for (;;) {
    const Waker::Outcome outcome = waker_.wait(file_.get(), std::nullopt);
    if (outcome.woken) return;
    uhid_event event{};
    if (read(file_.get(), &event, sizeof event) <= 0) continue;
    uhid_event reply{};
    const std::lock_guard lock(mutex_);
    if (event.type == UHID_GET_REPORT) {
      reply.type = UHID_GET_REPORT_REPLY;
      reply.u.get_report_reply.id = event.u.get_report.id;
      const auto known = features_.find(event.u.get_report.rnum);
      if (known == features_.end()) {
        reply.u.get_report_reply.err = EIO;
      } else {
        reply.u.get_report_reply.size = static_cast<__u16>(known->second.size());
        std::memcpy(reply.u.get_report_reply.data, known->second.data(), known->second.size());
      }
      put(file_.get(), reply);
    } else if (event.type == UHID_SET_REPORT) {
      const uhid_set_report_req& set = event.u.set_report;
      reply.type = UHID_SET_REPORT_REPLY;
      reply.u.set_report_reply.id = set.id;
      if (set.rtype == UHID_FEATURE_REPORT) features_[set.rnum] = bytes_of(set.data, set.size);
      put(file_.get(), reply);
    } else if (event.type == UHID_OUTPUT) {
      outputs_.push_back(bytes_of(event.u.output.data, event.u.output.size));
    }
  }
}

}  // namespace fude::lab
