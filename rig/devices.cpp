#include "rig/devices.h"

#include <algorithm>
#include <utility>

#include "drivers/transport/returning_source.h"
#include "drivers/transport/sleep_aware_source.h"
#include "drivers/transport/waker.h"
#include "rig/haptic_reader.h"

namespace fude {
namespace {

Transfer plug_transfer(TransferKind kind) {
  return {.time = monotonic_now(), .stamped_by = StampedBy::arrival, .kind = kind};
}

}  // namespace

Result<std::unique_ptr<Devices>> Devices::open(DeviceListener listener, DevicesWish wish) {
  // The monitor first, so that nothing plugged in meanwhile is missed.
  auto monitor = NodeMonitor::open(all_node_kinds);
  if (!monitor) return tl::unexpected(monitor.error());
  const auto found = attached_devices();
  if (!found) return tl::unexpected(found.error());
  std::unique_ptr<Devices> devices(new Devices(std::move(listener), std::move(wish), std::move(*monitor)));
  for (const AttachedDevice& device : *found) devices->plugged(device);
  for (const NamedDevice& device : devices->wish_.named) devices->add(device);
  devices->watching_ = std::thread([raw = devices.get()] { raw->watch(); });
  return devices;
}

Devices::Devices(DeviceListener listener, DevicesWish wish, std::unique_ptr<NodeMonitor> monitor)
    : listener_(std::move(listener)), wish_(std::move(wish)), monitor_(std::move(monitor)) {}

Devices::~Devices() { stop(); }

void Devices::stop() {
  stopping_ = true;
  monitor_->wake();
  if (watching_.joinable()) watching_.join();
  for (Slot& slot : slots_) slot.reader.reset();
}

std::vector<ReportCounts> Devices::counts() const {
  std::vector<ReportCounts> counts;
  for (const Slot& slot : slots_) counts.push_back(slot.decoder->counts());
  return counts;
}

void Devices::watch() {
  while (!stopping_) {
    const auto event = monitor_->next(std::nullopt);
    if (!event) continue;
    if (!event->plugged) {
      unplugged(event->node.path);
    } else if (const auto device = attached(event->node)) {
      plugged(*device);
    }
  }
}

void Devices::plugged(const AttachedDevice& found) {
  if (wish_.wanted && !wish_.wanted(found)) return;
  const auto open_here = [&](const Slot& slot) { return slot.node == found.node; };
  if (std::any_of(slots_.begin(), slots_.end(), open_here)) return;  // told twice
  auto slot = std::find_if(slots_.begin(), slots_.end(), [&](const Slot& s) {
    return s.node.empty() && s.description.id == found.description.id &&
           s.description.kind == found.description.kind;
  });
  const bool back = slot != slots_.end();
  auto decoder = back ? std::move(slot->decoder) : open_driver(*found.family, found.description);
  auto source = open_source(found, *decoder, wish_.camera);
  if (back) slot->decoder = std::move(decoder);
  if (!source) {
    listener_.refused(source.error());
    return;
  }
  if (!back) {
    slots_.push_back({found.description, {}, std::move(decoder), nullptr});
    slot = slots_.end() - 1;
  }
  slot->node = found.node;
  const auto number = static_cast<std::size_t>(slot - slots_.begin());
  if (back) {
    const Transfer again = plug_transfer(TransferKind::plugged);
    Decoded decoded;
    slot->decoder->decode(again, decoded);
    listener_.heard(number, again, decoded.samples);
  } else {
    listener_.appeared(number, slot->description);
  }
  if (const auto* camera = dynamic_cast<const V4l2Source*>(source->get()); camera && listener_.camera)
    listener_.camera(number, camera->settings());
  read(number, std::make_unique<SleepAwareSource>(std::move(*source), AfterSleep::goes_on, wish_.sleep));
}

void Devices::add(const NamedDevice& named) {
  slots_.push_back({named.description, {}, open_driver(*named.family, named.description), nullptr});
  const std::size_t number = slots_.size() - 1;
  listener_.appeared(number, named.description);
  // Tried again and again, told once an absence.
  read(number, std::make_unique<ReturningSource>([this, open = named.open, told = false]() mutable {
         auto source = open();
         if (!source && !told) listener_.refused(source.error());
         told = !source;
         if (source)
           *source = std::make_unique<SleepAwareSource>(std::move(*source), AfterSleep::is_opened_anew,
                                                        wish_.sleep);
         return source;
       }));
}

void Devices::read(std::size_t number, std::unique_ptr<ByteSource> source) {
  Slot& slot = slots_[number];
  const auto heard = [this, number](const Transfer& transfer, std::span<const Sample> samples) {
    listener_.heard(number, transfer, samples);
  };
  if (auto* arm = dynamic_cast<FalconDecoder*>(slot.decoder.get()))
    slot.reader = std::make_unique<HapticReader>(std::move(source), *arm, heard,
                                                 HapticWish{.feel = {}, .refused = listener_.refused});
  else
    slot.reader = std::make_unique<DeviceReader>(std::move(source), *slot.decoder, heard);
}

void Devices::unplugged(const std::filesystem::path& node) {
  for (std::size_t number = 0; number < slots_.size(); ++number) {
    Slot& slot = slots_[number];
    if (slot.node != node) continue;
    // Some kernels tell udev before they end the reading.
    if (slot.reader && !slot.reader->stop()) {
      const Transfer gone = plug_transfer(TransferKind::unplugged);
      Decoded decoded;
      slot.decoder->decode(gone, decoded);
      listener_.heard(number, gone, decoded.samples);
    }
    slot.reader.reset();
    slot.node.clear();
  }
}

}  // namespace fude
