// The newest of what one thread makes, for another that never waits.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace fude {

// Three places: one is written, one is read, and the third changes hands. No lock, and neither side ever
// waits for the other; what the reader was too slow for is gone. One thread puts, one looks.
template <class T>
class Newest {
 public:
  void put(const T& value) {
    places_[written_] = value;
    written_ = between_.exchange(written_ | fresh, std::memory_order_acq_rel) & place;
  }

  // The last that was put, T() before the first; it stays as it is until the next look().
  const T& look() {
    if (between_.load(std::memory_order_relaxed) & fresh)
      read_ = between_.exchange(read_, std::memory_order_acq_rel) & place;
    return places_[read_];
  }

 private:
  static constexpr unsigned fresh = 4;  // not looked at yet
  static constexpr unsigned place = 3;

  std::array<T, 3> places_{};
  std::atomic<unsigned> between_{0};
  unsigned written_ = 1;  // the putting thread's
  unsigned read_ = 2;     // the looking thread's
};

}  // namespace fude
