// A device's counter of few bits, carried on past its end.
#pragma once

#include <cstdint>

namespace fude {

class WrappingCounter {
 public:
  explicit WrappingCounter(unsigned bits) : bits_(bits) {}

  // How far it went on since the last value, 0 to 2^bits - 1; 0 for the first, which it starts from.
  std::uint64_t advance(std::uint64_t raw) {
    const std::uint64_t mask = (std::uint64_t{1} << bits_) - 1;
    const std::uint64_t step = started_ ? (raw - value_) & mask : 0;
    value_ = started_ ? value_ + step : raw & mask;
    started_ = true;
    return step;
  }

  // Whole turns that nobody saw, told by another clock.
  void add_turns(std::uint64_t turns) { value_ += turns << bits_; }

  bool started() const { return started_; }
  std::uint64_t value() const { return value_; }
  void forget() { started_ = false; }

 private:
  unsigned bits_;
  std::uint64_t value_ = 0;
  bool started_ = false;
};

}  // namespace fude
