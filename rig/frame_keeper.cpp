#include "rig/frame_keeper.h"

#include <utility>

namespace fude {
namespace {

// Few, for what waits here is not on the disk yet.
constexpr std::size_t most_waiting = 1;

}  // namespace

FrameKeeper::FrameKeeper(Encode encode, Keep keep)
    : encode_(std::move(encode)), keep_(std::move(keep)), thread_([this] { serve(); }) {}

FrameKeeper::~FrameKeeper() { finish(); }

void FrameKeeper::add(Transfer transfer, std::optional<CameraFrame> frame) {
  {
    const std::lock_guard lock(mutex_);
    const bool to_encode = frame && waiting_ < most_waiting;
    waiting_ += to_encode;
    queue_.push_back({std::move(transfer), std::move(frame), to_encode});
  }
  wake_.notify_one();
}

FrameKeeper::Counts FrameKeeper::finish() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  wake_.notify_one();
  if (thread_.joinable()) thread_.join();
  return counts_;
}

void FrameKeeper::serve() {
  for (;;) {
    std::unique_lock lock(mutex_);
    wake_.wait(lock, [this] { return ending_ || !queue_.empty(); });
    if (queue_.empty()) return;
    Item item = std::move(queue_.front());
    queue_.pop_front();
    waiting_ -= item.to_encode;
    lock.unlock();
    keep(std::move(item));
  }
}

void FrameKeeper::keep(Item item) {
  if (item.frame) {
    auto bytes = item.to_encode ? encode_(item.transfer.payload, *item.frame)
                                : failure(Fault::busy, "the encoder is behind");
    ++(bytes ? counts_.as_wished : counts_.as_sent);
    if (bytes) item.transfer.payload = std::move(*bytes);
  }
  keep_(std::move(item.transfer), std::move(item.frame));
}

}  // namespace fude
