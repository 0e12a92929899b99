#include "drivers/numbered_stream.h"

#include <cmath>

namespace fude {
namespace {

constexpr double turn_us = 4294967296.0;
constexpr double patience_us = 5e6;

}  // namespace

NumberedStream::Place NumberedStream::place(std::uint16_t number, std::uint32_t tick_us, Timestamp host) {
  Place place;
  if (!number_.started()) {
    number_.advance(number);
    tick_.advance(tick_us);
    place.after_gap = interrupted_;
  } else {
    const std::uint64_t numbers = number_.advance(number);
    const std::uint64_t ticks = tick_.advance(tick_us);
    if (numbers == 0 && ticks == 0) {
      place.repeated = true;
      return place;
    }
    const double passed_us = static_cast<double>((host - host_).count()) / 1e3;
    const double turns = std::round((passed_us - static_cast<double>(ticks)) / turn_us);
    const double astray_us = passed_us - static_cast<double>(ticks) - turns * turn_us;
    if (numbers == 0 || numbers >= 0x8000 || turns < 0 || std::abs(astray_us) > patience_us) {
      place.restarted = true;
      place.lost = 1;
      number_.forget();
      tick_.forget();
      number_.advance(number);
      tick_.advance(tick_us);
    } else {
      place.lost = numbers - 1;
      if (turns > 0) tick_.add_turns(static_cast<std::uint64_t>(turns));
    }
    place.after_gap = place.lost > 0;
  }
  interrupted_ = false;
  host_ = host;
  sequence_ += place.lost;
  place.sequence = sequence_++;
  place.tick_us = tick_.value();
  return place;
}

void NumberedStream::interrupted() {
  number_.forget();
  tick_.forget();
  interrupted_ = true;
}

}  // namespace fude
