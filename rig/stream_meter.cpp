#include "rig/stream_meter.h"

#include <algorithm>
#include <cstdlib>

namespace fude {
namespace {

constexpr std::size_t intervals_kept = 65536;

std::int64_t quantile(std::vector<std::int64_t>& values, double share) {
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace

StreamMeter::StreamMeter(std::optional<DeviceClock> clock) {
  if (clock) fitter_.emplace(ClockFitOptions{.clock = *clock});
}

void StreamMeter::add(const SampleTime& time, bool after_gap) {
  ++received_;
  gaps_ += after_gap;
  if (fitter_ && time.device_tick) fitter_->add({time.host, *time.device_tick});
  if (last_ && time.host == *last_) return;
  if (last_ && !after_gap) {
    const std::int64_t interval = (time.host - *last_).count();
    if (intervals_ns_.size() < intervals_kept)
      intervals_ns_.push_back(interval);
    else
      intervals_ns_[next_interval_] = interval;
    next_interval_ = (next_interval_ + 1) % intervals_kept;
  }
  last_ = time.host;
}

StreamFigures StreamMeter::figures() const {
  StreamFigures figures{.received = received_, .gaps = gaps_};
  if (fitter_) figures.clock = fitter_->lines();
  if (intervals_ns_.empty()) return figures;
  std::vector<std::int64_t> values = intervals_ns_;
  const std::int64_t median = quantile(values, 0.5);
  if (median > 0) figures.rate_hz = 1e9 / static_cast<double>(median);
  for (std::int64_t& value : values) value = std::abs(value - median);
  const auto us = [&values](double share) { return static_cast<double>(quantile(values, share)) * 1e-3; };
  figures.jitter_us = {us(0.5), us(0.99), us(1)};
  return figures;
}

}  // namespace fude
