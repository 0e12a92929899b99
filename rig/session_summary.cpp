#include "rig/session_summary.h"

#include <algorithm>

namespace fude {
namespace {

double median_rate_hz(const std::vector<Timestamp>& times) {
  std::vector<double> intervals;
  for (std::size_t i = 1; i < times.size(); ++i)
    if (times[i] > times[i - 1]) intervals.push_back(seconds(times[i] - times[i - 1]));
  if (intervals.empty()) return 0;
  const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2);
  std::nth_element(intervals.begin(), middle, intervals.end());
  return 1 / *middle;
}

StreamSummary stream(std::string name, std::string kind, std::string units,
                     const std::vector<Timestamp>& times, Timestamp origin) {
  StreamSummary s{std::move(name),
                  std::move(kind),
                  static_cast<std::int64_t>(times.size()),
                  median_rate_hz(times),
                  0,
                  0,
                  0,
                  std::move(units)};
  if (!times.empty()) {
    const auto [first, last] = std::minmax_element(times.begin(), times.end());
    s.start_s = seconds(*first - origin);
    s.end_s = seconds(*last - origin);
  }
  return s;
}

}  // namespace

bool counts_as_sample(const PenSample& pen) { return pen.in_proximity; }

SessionSpan span_of(const Session& session) {
  SessionSpan span;
  bool any = false;
  const auto widen = [&](Timestamp t) {
    span.first = any ? std::min(span.first, t) : t;
    span.last = any ? std::max(span.last, t) : t;
    any = true;
  };
  for (const RecordedPen& pen : session.pens)
    if (counts_as_sample(pen.sample)) widen(pen.sample.time.host);
  if (!any)
    for (const RecordedTransfer& t : session.transfers) widen(t.transfer.time);
  return span;
}

SessionSummary summarise(const Session& session) {
  SessionSummary summary;
  summary.complete = session.complete;
  const SessionSpan span = span_of(session);
  summary.duration_s = seconds(span.last - span.first);
  for (const RecordedCalibration& c : session.calibrations) summary.calibration.push_back(c.name);

  for (const RecordedDevice& device : session.devices) {
    std::vector<Timestamp> pens;
    std::int64_t gaps = 0;
    for (const RecordedPen& pen : session.pens) {
      if (pen.device != device.number) continue;
      gaps += pen.sample.after_gap;
      if (counts_as_sample(pen.sample)) pens.push_back(pen.sample.time.host);
    }
    std::vector<Timestamp> raw;
    for (const RecordedTransfer& t : session.transfers)
      if (t.device == device.number) raw.push_back(t.transfer.time);
    const bool text = device.description.transport == "text";
    if (!pens.empty() || raw.empty()) {
      summary.streams.push_back(stream(device.description.name, "pen",
                                       text ? "pixels, pressure 0 to 1" : "counts, pressure 0 to 1, radians",
                                       pens, span.first));
      summary.streams.back().gaps = gaps;
    }
    if (!raw.empty())
      summary.streams.push_back(stream(device.description.name, "raw", "evdev frames", raw, span.first));
  }
  if (!session.actions.empty()) {
    std::vector<Timestamp> times;
    for (const RecordedAction& a : session.actions) times.push_back(a.action.time);
    summary.streams.push_back(stream("painter", "actions", "", times, span.first));
  }
  return summary;
}

}  // namespace fude
