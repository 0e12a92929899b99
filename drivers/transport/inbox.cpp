#include "drivers/transport/inbox.h"

#include <utility>

namespace fude {

void Inbox::put(Transfer transfer) {
  {
    const std::lock_guard lock(mutex_);
    transfers_.push_back(std::move(transfer));
  }
  waker_.wake();
}

std::optional<Transfer> Inbox::take() {
  const std::lock_guard lock(mutex_);
  if (transfers_.empty()) return std::nullopt;
  std::optional<Transfer> first(std::move(transfers_.front()));
  transfers_.pop_front();
  return first;
}

void Inbox::wake() {
  {
    const std::lock_guard lock(mutex_);
    woken_ = true;
  }
  waker_.wake();
}

Inbox::Outcome Inbox::wait(int device, std::optional<Timestamp> deadline) {
  const Waker::Outcome outcome = waker_.wait(device, deadline);
  const std::lock_guard lock(mutex_);
  return {
      .ready = outcome.ready,
      .gone = outcome.gone,
      .woken = std::exchange(woken_, false),
      .late = !outcome.ready && !outcome.gone && !outcome.woken && deadline && monotonic_now() >= *deadline};
}

}  // namespace fude
