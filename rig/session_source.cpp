#include "rig/session_source.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace fude {

std::vector<Transfer> transfers_of(const Session& session, DeviceNumber device) {
  std::vector<Transfer> transfers;
  for (const RecordedTransfer& recorded : session.transfers)
    if (recorded.device == device) transfers.push_back(recorded.transfer);
  return transfers;
}

Timestamp PlayTime::due(Timestamp time) const {
  // In floating point, as the distance between two times of a damaged session may be no Duration.
  constexpr double century_ns = 3.2e18;
  const double distance_ns = (static_cast<double>(time.time_since_epoch().count()) -
                              static_cast<double>(recorded.time_since_epoch().count())) /
                             speed;
  return played + Duration(std::llround(std::clamp(distance_ns, -century_ns, century_ns)));
}

SessionSource::SessionSource(std::vector<Transfer> transfers, double speed, std::shared_ptr<Clock> clock)
    : transfers_(std::move(transfers)),
      clock_(speed == 0 ? std::make_shared<ManualClock>() : std::move(clock)) {
  if (!(speed >= 0) || !std::isfinite(speed)) throw std::invalid_argument("a speed is 0 or more");
  if (speed > 0) time_.speed = speed;
  if (!transfers_.empty()) seek(transfers_.front().time, clock_->now());
}

void SessionSource::seek(Timestamp recorded, Timestamp played) {
  time_.recorded = recorded;
  time_.played = played;
  next_ = 0;
  const auto first = std::find_if(transfers_.begin(), transfers_.end(),
                                  [&](const Transfer& transfer) { return transfer.time >= recorded; });
  sought_ = static_cast<std::size_t>(first - transfers_.begin());
}

std::optional<Timestamp> SessionSource::next_time() const {
  if (next_ == transfers_.size()) return std::nullopt;
  return transfers_[next_].time;
}

Result<std::optional<Transfer>> SessionSource::read(std::optional<Timestamp> deadline) {
  if (next_ == transfers_.size()) return failure(Fault::device_gone, "the recording is over");
  if (!leading()) {
    const Timestamp due = time_.due(transfers_[next_].time);
    const bool too_late = deadline && *deadline < due;
    if (!clock_->wait(too_late ? *deadline : due, waker_) || too_late) return std::nullopt;
  }
  return transfers_[next_++];
}

}  // namespace fude
