// A device on a machine that may be suspended: its stream says where it slept.
#pragma once

#include <deque>
#include <memory>

#include "drivers/transport/sleep_watch.h"
#include "signal/byte_source.h"

namespace fude {

enum class AfterSleep : std::uint8_t {
  goes_on,        // the device is still there, though it may have lost its state
  is_opened_anew  // nobody can tell whether the other end is: a network peer, a serial line
};

class SleepAwareSource final : public ByteSource {
 public:
  SleepAwareSource(std::unique_ptr<ByteSource> source, AfterSleep after, SleepWatch watch);

  // What the device gives. Once the machine has slept, `suspended` comes first and then `plugged`, at which a
  // reader greets the device again; or, where it is to be opened anew, what had come, `suspended` and the
  // error device_gone. A sleep is noticed with the next transfer, else within a second: a read() gives none
  // that often. The marks have the time of what came after, or now: the clock stood still meanwhile.
  Result<std::optional<Transfer>> read(std::optional<Timestamp> deadline) override;
  Result<void> write(const Transfer& transfer) override { return source_->write(transfer); }
  void wake() override { source_->wake(); }

 private:
  std::unique_ptr<ByteSource> source_;
  AfterSleep after_;
  SleepWatch watch_;
  std::deque<Transfer> marked_;  // to be given before anything else is read
  bool gone_ = false;
};

}  // namespace fude
