// A device made of a recording, with faults where the test wants them.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <optional>
#include <set>
#include <vector>

#include "signal/byte_source.h"

namespace fude {

struct Replay {
  std::vector<Transfer> transfers;
  std::set<std::size_t> stalls;  // before these transfers the device says nothing until woken
};

// Faults, each at transfer `at` of a recording.
Replay unplugged(Replay replay, std::size_t at, std::size_t missing);  // `missing` transfers never come
Replay dropped(Replay replay, std::size_t at, std::size_t missing);    // SYN_DROPPED in their place
Replay garbage(Replay replay, std::size_t at);                         // a frame of hostile events goes in
Replay cut(Replay replay, std::size_t at);                             // its payload loses its last bytes

// Plays as fast as it is read; when the recording is over the device is gone.
class ReplaySource final : public ByteSource {
 public:
  explicit ReplaySource(Replay replay) : replay_(std::move(replay)) {}
  Result<std::optional<Transfer>> read(std::optional<Timestamp> deadline) override;
  void wake() override;

 private:
  Replay replay_;
  std::size_t at_ = 0;
  std::mutex mutex_;
  std::condition_variable waiting_;
  bool woken_ = false;
};

}  // namespace fude
