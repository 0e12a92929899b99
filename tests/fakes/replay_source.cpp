#include "tests/fakes/replay_source.h"

#include <linux/input-event-codes.h>

#include <cstdint>
#include <initializer_list>
#include <limits>
#include <utility>

namespace fude {
namespace {

auto place(Replay& replay, std::size_t at) {
  return replay.transfers.begin() + static_cast<std::ptrdiff_t>(at);
}

Transfer at_time_of(const Replay& replay, std::size_t at) {
  Transfer transfer = replay.transfers.at(at);
  transfer.payload.clear();
  return transfer;
}

}  // namespace

Replay unplugged(Replay replay, std::size_t at, std::size_t missing) {
  Transfer gone = at_time_of(replay, at);
  gone.kind = TransferKind::unplugged;
  Transfer back = at_time_of(replay, at + missing);
  back.kind = TransferKind::plugged;
  replay.transfers.erase(place(replay, at), place(replay, at + missing));
  replay.transfers.insert(place(replay, at), {gone, back});
  return replay;
}

Replay dropped(Replay replay, std::size_t at, std::size_t missing) {
  Transfer drop = at_time_of(replay, at);
  const EvdevEvent event{EV_SYN, SYN_DROPPED, 0};
  drop.payload = pack_events({&event, 1});
  replay.transfers.erase(place(replay, at), place(replay, at + missing));
  replay.transfers.insert(place(replay, at), drop);
  return replay;
}

Replay garbage(Replay replay, std::size_t at) {
  Transfer hostile = at_time_of(replay, at);
  std::vector<EvdevEvent> events;
  for (const std::uint16_t type : std::initializer_list<std::uint16_t>{EV_KEY, EV_ABS, EV_MSC, EV_REL, 0x1f})
    for (std::uint16_t code = 0; code < KEY_CNT; ++code)
      if (!(type == EV_KEY && code >= BTN_DIGI && code <= BTN_STYLUS2))  // leave the tool in hand
        events.push_back(
            {type, code,
             code % 2 ? std::numeric_limits<std::int32_t>::max() : std::numeric_limits<std::int32_t>::min()});
  events.push_back({EV_SYN, SYN_REPORT, 0});
  hostile.payload = pack_events(events);
  replay.transfers.insert(place(replay, at), hostile);
  return replay;
}

Replay cut(Replay replay, std::size_t at) {
  replay.transfers.at(at).payload.resize(replay.transfers.at(at).payload.size() - 3);
  return replay;
}

Result<std::optional<Transfer>> ReplaySource::read(std::optional<Timestamp>) {
  std::unique_lock lock(mutex_);
  if (replay_.stalls.erase(at_) > 0) {
    waiting_.wait(lock, [this] { return woken_; });
    woken_ = false;
    return std::nullopt;
  }
  if (at_ == replay_.transfers.size()) return failure(Fault::device_gone, "the recording is over");
  return replay_.transfers[at_++];
}

void ReplaySource::wake() {
  const std::lock_guard lock(mutex_);
  woken_ = true;
  waiting_.notify_all();
}

}  // namespace fude
