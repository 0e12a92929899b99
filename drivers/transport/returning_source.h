// A device that may go away and come back, under whatever node: one stream all the while.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <optional>

#include "drivers/transport/waker.h"
#include "signal/byte_source.h"

namespace fude {

class ReturningSource final : public ByteSource {
 public:
  // Looks for the device by its identity and opens it; fails while it is not there.
  using Open = std::function<Result<std::unique_ptr<ByteSource>>()>;

  // Looks at once, and again each `pause` while the device is away, however often it is read.
  explicit ReturningSource(Open open, Duration pause = std::chrono::milliseconds(100));

  // What the device gives. After its `unplugged` it waits for the device's return, which gives `plugged`, so
  // that it never fails with device_gone. The first appearance gives `plugged` too.
  Result<std::optional<Transfer>> read(std::optional<Timestamp> deadline) override;

  // Errors: device_gone while it is away.
  Result<void> write(const Transfer& transfer) override;
  void wake() override;

 private:
  std::shared_ptr<ByteSource> present() const;
  void set_present(std::shared_ptr<ByteSource> source);

  Open open_;
  Duration pause_;
  Timestamp next_look_{};
  Waker waker_;
  mutable std::mutex mutex_;
  std::shared_ptr<ByteSource> source_;
};

}  // namespace fude
