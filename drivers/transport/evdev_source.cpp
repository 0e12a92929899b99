#include "drivers/transport/evdev_source.h"

#include <fcntl.h>
#include <linux/input.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <ctime>
#include <utility>

#include "drivers/transport/device_node.h"

namespace fude {

DeviceDescription describe(const libevdev* device) {
  DeviceDescription description;
  description.name = libevdev_get_name(device);
  description.transport = "evdev";
  description.bus = static_cast<std::uint16_t>(libevdev_get_id_bustype(device));
  description.vendor = static_cast<std::uint16_t>(libevdev_get_id_vendor(device));
  description.product = static_cast<std::uint16_t>(libevdev_get_id_product(device));
  description.version = static_cast<std::uint16_t>(libevdev_get_id_version(device));
  if (const char* unique = libevdev_get_uniq(device)) description.serial = unique;
  for (unsigned code = 0; code <= KEY_MAX; ++code)
    if (libevdev_has_event_code(device, EV_KEY, code))
      description.keys.push_back(static_cast<std::uint16_t>(code));
  for (unsigned property = 0; property <= INPUT_PROP_MAX; ++property)
    if (libevdev_has_property(device, property))
      description.properties.push_back(static_cast<std::uint16_t>(property));
  for (unsigned code = 0; code <= ABS_MAX; ++code)
    if (const input_absinfo* axis = libevdev_get_abs_info(device, code))
      description.axes.push_back({static_cast<std::uint16_t>(code), axis->minimum, axis->maximum, axis->fuzz,
                                  axis->flat, axis->resolution, axis->value});
  description.id = device_id(description);
  return description;
}

Result<std::unique_ptr<EvdevSource>> EvdevSource::open(const std::filesystem::path& node) {
  FileDescriptor file(::open(node.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  if (file.get() < 0) {
    if (errno == EACCES || errno == EPERM) return failure(Fault::no_access, access_advice(node));
    return failure(Fault::not_found,
                   node.string() + ": " + std::strerror(errno) + "; is the tablet plugged in?");
  }
  libevdev* raw = nullptr;
  if (const int status = libevdev_new_from_fd(file.get(), &raw); status < 0)
    return failure(Fault::unsupported, node.string() + " is no input device (" + std::strerror(-status) +
                                           "); name a /dev/input/event…");
  return std::unique_ptr<EvdevSource>(new EvdevSource(std::move(file), Device(raw, libevdev_free)));
}

EvdevSource::EvdevSource(FileDescriptor file, Device device)
    : file_(std::move(file)), device_(std::move(device)), description_(describe(device_.get())) {
  if (libevdev_set_clock_id(device_.get(), CLOCK_MONOTONIC) != 0) stamped_by_ = StampedBy::arrival;
  tell_held_keys();
}

// A pen may be near already; only a change would be sent, so what is held down is told first.
void EvdevSource::tell_held_keys() {
  for (const std::uint16_t key : description_.keys)
    if (libevdev_get_event_value(device_.get(), EV_KEY, key) != 0) frame_.push_back({EV_KEY, key, 1});
  if (frame_.empty()) return;
  frame_.push_back({EV_SYN, SYN_REPORT, 0});
  close_frame(monotonic_now(), StampedBy::arrival);
}

Result<std::optional<Transfer>> EvdevSource::read(std::optional<Timestamp> deadline) {
  if (ready_.empty() && !gone_) take_events();  // what libevdev has read already
  for (;;) {
    if (!ready_.empty()) {
      std::optional<Transfer> first(std::move(ready_.front()));
      ready_.pop_front();
      return first;
    }
    if (gone_) return failure(Fault::device_gone, description_.name + " was unplugged; plug it in again");
    const Waker::Outcome outcome = waker_.wait(file_.get(), deadline);
    if (outcome.ready) take_events();
    if (outcome.gone && ready_.empty()) unplugged();
    if (outcome.woken || !(outcome.ready || outcome.gone)) return std::nullopt;
  }
}

void EvdevSource::take_events() {
  for (;;) {
    input_event event{};
    const int status = libevdev_next_event(device_.get(), LIBEVDEV_READ_FLAG_NORMAL, &event);
    if (status == LIBEVDEV_READ_STATUS_SUCCESS) {
      frame_.push_back({event.type, event.code, event.value});
      if (event.type == EV_SYN && event.code == SYN_REPORT) return close_frame(stamp_of(event), stamped_by_);
    } else if (status == LIBEVDEV_READ_STATUS_SYNC) {
      return resynchronise();
    } else {
      // A read of half an event can come only from a broken kernel or a fake: the device is useless.
      if (status != -EAGAIN && status != -EINTR) unplugged();
      return;
    }
  }
}

void EvdevSource::resynchronise() {
  std::vector<EvdevEvent> changed;
  input_event event{};
  while (libevdev_next_event(device_.get(), LIBEVDEV_READ_FLAG_SYNC, &event) == LIBEVDEV_READ_STATUS_SYNC)
    if (event.type != EV_SYN) changed.push_back({event.type, event.code, event.value});

  // The state was asked for now, whatever the last event says.
  const Timestamp now = monotonic_now();
  frame_.push_back({EV_SYN, SYN_DROPPED, 0});
  frame_.push_back({EV_SYN, SYN_REPORT, 0});
  close_frame(now, StampedBy::arrival);
  frame_ = std::move(changed);
  frame_.push_back({EV_SYN, SYN_REPORT, 0});
  close_frame(now, StampedBy::arrival);
}

Timestamp EvdevSource::stamp_of(const input_event& event) const {
  if (stamped_by_ == StampedBy::arrival) return monotonic_now();
  return Timestamp(std::chrono::seconds(event.input_event_sec) +
                   std::chrono::microseconds(event.input_event_usec));
}

void EvdevSource::close_frame(Timestamp time, StampedBy stamped_by) {
  ready_.push_back(
      {time, stamped_by, Direction::from_device, TransferKind::evdev_frame, pack_events(frame_)});
  frame_.clear();
}

void EvdevSource::unplugged() {
  gone_ = true;
  frame_.clear();
  ready_.push_back(
      {monotonic_now(), StampedBy::arrival, Direction::from_device, TransferKind::unplugged, {}});
}

}  // namespace fude
