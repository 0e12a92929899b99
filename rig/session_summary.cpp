#include "rig/session_summary.h"

#include <algorithm>
#include <span>

#include "capture/streams.h"

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

// Of the columns that have one, each once.
std::string units_of(std::size_t kind, const DeviceDescription& device) {
  const SampleTable& table = sample_tables()[kind];
  if (table.stream == "pen")
    return device.transport != "text" ? "counts, pressure 0 to 1, radians"
           : device.mm_per_count == 1 ? "millimetres, pressure 0 to 1, radians"
                                      : "pixels, pressure 0 to 1, radians";
  std::string units;
  for (const SampleColumn& column : std::span(table.columns).subspan(4))
    if (!column.unit.empty() && (", " + units + ", ").find(", " + column.unit + ", ") == std::string::npos)
      units += (units.empty() ? "" : ", ") + column.unit;
  return units;
}

// The kind of stream that a device which sent nothing would have had.
std::string word_for_device(const DeviceDescription& device) {
  return device.kind == DeviceKind::pen_tablet || device.transport == "evdev" ? "pen" : "raw";
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
  if (!any) {
    for (const RecordedTransfer& t : session.transfers) widen(t.transfer.time);
    for (const RecordedSample& s : session.samples) widen(time_of(s.sample).host);
  }
  return span;
}

SessionSummary summarise(const Session& session) {
  SessionSummary summary;
  summary.complete = session.complete;
  const SessionSpan span = span_of(session);
  summary.duration_s = seconds(span.last - span.first);
  for (const RecordedCalibration& c : session.calibrations) summary.calibration.push_back(c.name);

  const std::vector<SessionStream> streams = streams_of(session);
  for (const RecordedDevice& device : session.devices) {
    bool sampled = false;
    for (const SessionStream& of : streams) {
      if (of.device != device.number) continue;
      std::vector<Timestamp> times;
      std::int64_t gaps = 0;
      for (std::size_t i = 0; i < of.samples.size(); ++i) {
        const Sample sample = sample_at(session, of, i);
        gaps += after_gap(sample);
        const auto* pen = std::get_if<PenSample>(&sample);
        if (pen == nullptr || counts_as_sample(*pen)) times.push_back(time_of(sample).host);
      }
      if (times.empty() && of.samples.empty()) continue;
      sampled = true;
      const std::string& kind = sample_tables()[of.kind].stream;
      summary.streams.push_back(
          stream(of.name, kind, units_of(of.kind, device.description), times, span.first));
      summary.streams.back().gaps = gaps;
    }
    std::vector<Timestamp> raw;
    for (const RecordedTransfer& t : session.transfers)
      if (t.device == device.number) raw.push_back(t.transfer.time);
    if (raw.empty() && !sampled)  // a device that was there and silent
      summary.streams.push_back(
          stream(device.description.name, word_for_device(device.description), "", {}, span.first));
    if (!raw.empty())
      summary.streams.push_back(stream(device.description.name, "raw",
                                       device.description.transport == "evdev" ? "evdev frames" : "transfers",
                                       raw, span.first));
  }
  if (!session.actions.empty()) {
    std::vector<Timestamp> times;
    for (const RecordedAction& a : session.actions) times.push_back(a.action.time);
    summary.streams.push_back(stream("painter", "actions", "", times, span.first));
  }
  return summary;
}

}  // namespace fude
