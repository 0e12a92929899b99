#include "rig/recorded_driver.h"

#include <algorithm>
#include <utility>

#include "drivers/families.h"
#include "drivers/tablet/hid_pen_decoder.h"
#include "drivers/tablet/identify.h"
#include "drivers/transport/hid_descriptor.h"

namespace fude {
namespace {

constexpr std::uint16_t nintendo = 0x057e;
constexpr DeviceClock joycon_clock{64, 1e-6};  // its decoder counts microseconds

// Events without a description still belong to some device; its axes are not known.
DeviceDescription undescribed() {
  DeviceDescription device;
  device.name = "a device without a description";
  device.transport = "evdev";
  return device;
}

std::optional<HidUsage> top_usage(const DeviceDescription& device) {
  const auto parsed = hid::parse_descriptor(device.hid_descriptor);
  if (!parsed || parsed->inputs.empty()) return std::nullopt;
  const hid::Usage usage = parsed->inputs.front().application;
  return HidUsage{static_cast<std::uint16_t>(usage >> 16), static_cast<std::uint16_t>(usage)};
}

// A Joy-Con's rail does not say which one it is; they are alike.
const FamilyRow* family_of(const DeviceDescription& device) {
  if (device.transport == "serial" && device.vendor == nintendo) return find_family("joycon", "hidraw");
  return find_family(device, top_usage(device));
}

}  // namespace

RecordedDriver::RecordedDriver(std::optional<DeviceDescription> device, std::span<const Transfer> transfers)
    : device_(device ? std::move(*device) : undescribed()) {
  if (device_.transport == "text") return;
  if (device_.transport == "evdev") {
    device_ = identified(device_);
    if (device_.kind == DeviceKind::pen_tablet) {
      evdev_.emplace(device_);
      return;
    }
  } else if (auto pen = described_hid_pen(device_, transfers)) {
    device_ = std::move(*pen);
    decoder_ = std::make_unique<HidPenDecoder>(device_);
    return;
  }
  if (const FamilyRow* row = family_of(device_)) {
    device_.kind = row->kind;
    if (row->family == Family::joycon) device_.clock = joycon_clock;
    decoder_ = open_decoder(*row, device_);
  }
}

void RecordedDriver::decode(const Transfer& transfer, std::vector<Sample>& out) {
  if (evdev_) {
    if (auto sample = evdev_->decode(transfer)) out.emplace_back(std::move(*sample));
  } else if (decoder_) {
    Decoded decoded;
    decoder_->decode(transfer, decoded);
    std::move(decoded.samples.begin(), decoded.samples.end(), std::back_inserter(out));
  }
}

std::uint64_t RecordedDriver::lost() const {
  if (evdev_) return evdev_->counts().lost + evdev_->counts().malformed;
  return decoder_ ? decoder_->counts().lost : 0;
}

std::uint64_t RecordedDriver::not_understood() const {
  return decoder_ ? decoder_->counts().malformed + decoder_->counts().unknown : 0;
}

}  // namespace fude
