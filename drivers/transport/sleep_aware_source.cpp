#include "drivers/transport/sleep_aware_source.h"

#include <algorithm>
#include <utility>

#include "drivers/transport/waker.h"

namespace fude {
namespace {

constexpr Duration between_looks = std::chrono::seconds(1);

bool tells_of_presence(const Transfer& transfer) {
  return transfer.kind == TransferKind::plugged || transfer.kind == TransferKind::unplugged;
}

}  // namespace

SleepAwareSource::SleepAwareSource(std::unique_ptr<ByteSource> source, AfterSleep after, SleepWatch watch)
    : source_(std::move(source)), after_(after), watch_(std::move(watch)) {
  watch_.slept();  // before this, nothing was lost
}

Result<std::optional<Transfer>> SleepAwareSource::read(std::optional<Timestamp> deadline) {
  if (marked_.empty()) {
    if (gone_) return failure(Fault::device_gone, "the machine was suspended; the device is opened anew");
    const Timestamp look = monotonic_now() + between_looks;
    auto read = source_->read(deadline ? std::min(*deadline, look) : look);
    if (!read || (*read && tells_of_presence(**read)) || !watch_.slept()) return read;
    const Timestamp now = monotonic_now();
    const auto mark = [&](TransferKind kind) {
      marked_.push_back({.time = *read ? std::min((*read)->time, now) : now,
                         .stamped_by = StampedBy::arrival,
                         .kind = kind});
    };
    gone_ = after_ == AfterSleep::is_opened_anew;
    if (*read && gone_) marked_.push_back(**read);
    mark(TransferKind::suspended);
    if (!gone_) mark(TransferKind::plugged);
    if (*read && !gone_) marked_.push_back(std::move(**read));
  }
  Transfer next = std::move(marked_.front());
  marked_.pop_front();
  return next;
}

}  // namespace fude
