#include "rig/tablets.h"

#include <algorithm>
#include <utility>

#include "drivers/transport/evdev_source.h"

namespace fude {
namespace {

Transfer plug_transfer(TransferKind kind) {
  return {monotonic_now(), StampedBy::arrival, Direction::from_device, kind, {}};
}

}  // namespace

Result<std::unique_ptr<Tablets>> Tablets::open(TabletListener listener) {
  // The monitor first, so that nothing plugged in meanwhile is missed.
  auto monitor = PlugMonitor::open();
  if (!monitor) return tl::unexpected(monitor.error());
  const auto found = find_pen_tablets();
  if (!found) return tl::unexpected(found.error());
  std::unique_ptr<Tablets> tablets(new Tablets(std::move(listener), std::move(*monitor)));
  for (const FoundDevice& device : *found) tablets->plugged(device);
  tablets->watching_ = std::thread([raw = tablets.get()] { raw->watch(); });
  return tablets;
}

Tablets::Tablets(TabletListener listener, std::unique_ptr<PlugMonitor> monitor)
    : listener_(std::move(listener)), monitor_(std::move(monitor)) {}

Tablets::~Tablets() { stop(); }

void Tablets::stop() {
  stopping_ = true;
  monitor_->wake();
  if (watching_.joinable()) watching_.join();
  for (Slot& slot : slots_) slot.reader.reset();
}

std::vector<DecodeCounts> Tablets::counts() const {
  std::vector<DecodeCounts> counts;
  for (const Slot& slot : slots_) counts.push_back(slot.decoder->counts());
  return counts;
}

void Tablets::watch() {
  while (!stopping_) {
    const auto event = monitor_->next(std::nullopt);
    if (!event) continue;
    if (!event->plugged)
      unplugged(event->node);
    else if (event->tablet)
      plugged(*event->tablet);
  }
}

void Tablets::plugged(const FoundDevice& found) {
  const auto open_here = [&](const Slot& slot) { return slot.node == found.node; };
  if (std::any_of(slots_.begin(), slots_.end(), open_here)) return;  // told twice
  auto source = EvdevSource::open(found.node);
  if (!source) {
    listener_.refused(source.error());
    return;
  }
  auto slot = std::find_if(slots_.begin(), slots_.end(), [&](const Slot& s) {
    return s.node.empty() && s.description.id == found.description.id;
  });
  const bool back = slot != slots_.end();
  if (!back) {
    slots_.push_back({found.description, {}, std::make_unique<PenDecoder>(found.description), nullptr});
    slot = slots_.end() - 1;
  }
  slot->node = found.node;
  const auto number = static_cast<std::size_t>(slot - slots_.begin());
  if (back)
    listener_.heard(number, plug_transfer(TransferKind::plugged), std::nullopt);
  else
    listener_.appeared(number, slot->description);
  slot->reader = std::make_unique<TabletReader>(
      std::move(*source), *slot->decoder,
      [this, number](const Transfer& transfer, const std::optional<PenSample>& sample) {
        listener_.heard(number, transfer, sample);
      });
}

void Tablets::unplugged(const std::filesystem::path& node) {
  for (std::size_t number = 0; number < slots_.size(); ++number) {
    Slot& slot = slots_[number];
    if (slot.node != node) continue;
    // Some kernels tell udev before they end the reading.
    if (slot.reader && !slot.reader->stop()) {
      const Transfer gone = plug_transfer(TransferKind::unplugged);
      listener_.heard(number, gone, slot.decoder->decode(gone));
    }
    slot.reader.reset();
    slot.node.clear();
  }
}

}  // namespace fude
