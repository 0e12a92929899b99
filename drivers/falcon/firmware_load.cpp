#include "drivers/falcon/firmware_load.h"

#include <algorithm>

#include "drivers/falcon/ftdi.h"

namespace fude::falcon {
namespace {

constexpr std::size_t block_length = 62;
constexpr int most_attempts = 10;
constexpr Duration patience = std::chrono::seconds(1);

constexpr std::uint16_t baud_9600 = 0x4138;
constexpr std::uint16_t baud_140000 = 0x0015;
constexpr std::uint16_t baud_1500000 = 0x0002;

}  // namespace

std::vector<Transfer> normal_mode() {
  return {latency_ms(1), baud_divisor(baud_1500000), purge_received(), purge_sent()};
}

std::vector<Transfer> FirmwareLoad::begin(Timestamp now) {
  attempts_ = 0;
  return again(now);
}

std::vector<Transfer> FirmwareLoad::again(Timestamp now) {
  if (image_.empty() || ++attempts_ > most_attempts) {
    state_ = State::failed;
    return {};
  }
  return call(now);
}

std::vector<Transfer> FirmwareLoad::call(Timestamp now) {
  state_ = State::calling;
  heard_.clear();
  confirmed_ = sent_ = 0;
  since_ = now;
  return {purge_received(), purge_sent(),
          latency_ms(16),   baud_divisor(baud_9600),
          eight_bits(),     no_flow_control(),
          rts(false),       dtr(false),
          dtr(true),        bulk(octets({0x0a, 0x43, 0x0d}))};
}

std::vector<Transfer> FirmwareLoad::ask() {
  state_ = State::asking;
  heard_.clear();
  return {dtr(false), baud_divisor(baud_140000), bulk(octets({0x41}))};
}

std::vector<Transfer> FirmwareLoad::next_block() {
  if (confirmed_ == image_.size()) {
    state_ = State::loaded;
    return normal_mode();
  }
  state_ = State::sending;
  const std::size_t length = std::min(block_length, image_.size() - confirmed_);
  sent_ = confirmed_ + length;
  const auto from = image_.begin() + static_cast<std::ptrdiff_t>(confirmed_);
  return {bulk({from, from + static_cast<std::ptrdiff_t>(length)})};
}

std::vector<Transfer> FirmwareLoad::hear(Bytes bytes, Timestamp now) {
  if (state_ != State::calling && state_ != State::asking && state_ != State::sending) return {};
  if (bytes.empty()) return now - since_ > patience ? again(now) : std::vector<Transfer>{};
  since_ = now;
  append(heard_, bytes);
  switch (state_) {
    case State::calling: {
      static const auto answer = octets({0x0a, 0x44, 0x2c, 0x0d});
      const auto start = std::find(heard_.begin(), heard_.end(), answer[0]);  // a zero may stand before it
      const auto length = std::min<std::ptrdiff_t>(heard_.end() - start, std::ssize(answer));
      if (!std::equal(start, start + length, answer.begin()) || start - heard_.begin() > 1) return again(now);
      return length == std::ssize(answer) ? ask() : std::vector<Transfer>{};
    }
    case State::asking:
      if (heard_ != octets({0x41})) return again(now);
      heard_.clear();
      return next_block();
    default: {
      const std::size_t due = sent_ - confirmed_;
      const auto from = image_.begin() + static_cast<std::ptrdiff_t>(confirmed_);
      if (heard_.size() > due || !std::equal(heard_.begin(), heard_.end(), from)) return again(now);
      if (heard_.size() < due) return {};
      confirmed_ = sent_;
      heard_.clear();
      return next_block();
    }
  }
}

}  // namespace fude::falcon
