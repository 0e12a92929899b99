#include "drivers/transport/returning_source.h"

#include <utility>

namespace fude {

ReturningSource::ReturningSource(Open open, Duration pause) : open_(std::move(open)), pause_(pause) {}

std::shared_ptr<ByteSource> ReturningSource::present() const {
  const std::lock_guard lock(mutex_);
  return source_;
}

void ReturningSource::set_present(std::shared_ptr<ByteSource> source) {
  const std::lock_guard lock(mutex_);
  source_ = std::move(source);
}

Result<std::optional<Transfer>> ReturningSource::read(std::optional<Timestamp> deadline) {
  if (const auto source = present()) {
    auto transfer = source->read(deadline);
    if (transfer || transfer.error().fault != Fault::device_gone) return transfer;
    set_present(nullptr);
    next_look_ = {};
  }
  for (;;) {
    if (monotonic_now() >= next_look_) {
      if (auto source = open_()) {
        set_present(std::move(*source));
        return Transfer{
            monotonic_now(), StampedBy::arrival, Direction::from_device, TransferKind::plugged, {}};
      }
      next_look_ = monotonic_now() + pause_;
    }
    const bool last = deadline && *deadline <= next_look_;
    if (waker_.wait(-1, last ? *deadline : next_look_).woken || last) return std::nullopt;
  }
}

Result<void> ReturningSource::write(const Transfer& transfer) {
  if (const auto source = present()) return source->write(transfer);
  return failure(Fault::device_gone, "the device is unplugged; plug it in again");
}

// The reader may be waiting at either; a wake-up too many only gives one read() more that is empty.
void ReturningSource::wake() {
  waker_.wake();
  if (const auto source = present()) source->wake();
}

}  // namespace fude
