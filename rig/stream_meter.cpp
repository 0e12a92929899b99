#include "rig/stream_meter.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace fude {
namespace {

constexpr std::size_t kept = 65536;

void keep(std::int64_t value, std::vector<std::int64_t>& ring, std::size_t& next) {
  if (ring.size() < kept)
    ring.push_back(value);
  else
    ring[next] = value;
  next = (next + 1) % kept;
}

std::int64_t quantile(std::vector<std::int64_t>& values, double share) {
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

StreamFigures::Spread quantiles_us(std::vector<std::int64_t> values) {
  const auto us = [&values](double share) { return static_cast<double>(quantile(values, share)) * 1e-3; };
  return {us(0.5), us(0.99), us(1)};
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
  if (last_ && !after_gap) keep((time.host - *last_).count(), intervals_ns_, next_interval_);
  last_ = time.host;
}

void StreamMeter::decoded_after(Duration delay) { keep(delay.count(), delays_ns_, next_delay_); }

StreamFigures StreamMeter::figures() const {
  StreamFigures figures{.received = received_, .gaps = gaps_};
  if (fitter_) figures.clock = fitter_->lines();
  if (!delays_ns_.empty()) figures.delay_us = quantiles_us(delays_ns_);
  if (intervals_ns_.empty()) return figures;
  std::vector<std::int64_t> values = intervals_ns_;
  const std::int64_t median = quantile(values, 0.5);
  if (median > 0) figures.rate_hz = 1e9 / static_cast<double>(median);
  for (std::int64_t& value : values) {
    value = std::abs(value - median);
    const auto bin = std::ranges::upper_bound(
        jitter_bins_us, static_cast<int>(std::min<std::int64_t>(value / 1000, 1'000'000)));
    ++figures.jitter_histogram[static_cast<std::size_t>(bin - jitter_bins_us.begin())];
  }
  figures.jitter_us = quantiles_us(std::move(values));
  return figures;
}

}  // namespace fude
