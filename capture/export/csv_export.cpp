#include "capture/export/csv_export.h"

#include <array>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <optional>

#include "capture/import/csv_rows.h"
#include "capture/import/text_fields.h"
#include "capture/session_words.h"

namespace fude {
namespace {

constexpr std::size_t time_columns = 4;

void append(std::string& out, std::string_view text) {
  if (text.find_first_of(",\"\n\r#") == std::string_view::npos) {
    out += text;
    return;
  }
  out += '"';
  for (const char c : text) out.append(c == '"' ? 2 : 1, c == '\n' || c == '\r' ? ' ' : c);
  out += '"';
}

template <class Number>
void append_number(std::string& out, Number number) {
  std::array<char, 32> digits;
  out.append(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr);
}

void append(std::string& out, const Cell& cell) {
  if (const auto* whole = std::get_if<std::int64_t>(&cell)) append_number(out, *whole);
  if (const auto* real = std::get_if<double>(&cell)) append_number(out, *real);
  if (const auto* text = std::get_if<std::string>(&cell)) append(out, std::string_view(*text));
}

void append(std::string& out, Timestamp time) {
  const std::int64_t ns = time.time_since_epoch().count();
  char text[32];
  std::snprintf(text, sizeof text, "%s%lld.%09lld", ns < 0 ? "-" : "", std::llabs(ns / 1'000'000'000),
                std::llabs(ns % 1'000'000'000));
  out += text;
}

// The lines of the stream's clock: as recorded, else fitted now where the device's counter is known.
std::vector<ClockLine> clock_lines(const Session& session, const SessionStream& stream) {
  std::vector<ClockLine> lines;
  for (const RecordedClockFit& fit : session.clock_fits)
    if (fit.device == stream.device && fit.part == stream.part) lines.push_back(fit.line);
  if (!lines.empty()) return lines;
  for (const RecordedDevice& device : session.devices) {
    if (device.number != stream.device || !device.description.clock) continue;
    std::vector<ClockReading> readings;
    for (std::size_t i = 0; i < stream.samples.size(); ++i) {
      const SampleTime time = time_of(sample_at(session, stream, i));
      if (time.device_tick) readings.push_back({time.host, *time.device_tick});
    }
    lines = fit_clock(readings, {.clock = *device.description.clock}).lines;
  }
  return lines;
}

bool wanted(const SampleColumn& column) { return column.name != "valid"; }

}  // namespace

std::string csv_of(const Session& session, const SessionStream& stream) {
  const SampleTable& table = sample_tables()[stream.kind];
  std::string out = "# host_s s; fitted_s s";
  std::string names = "host_s,tick,sequence,fitted_s,valid,stamped_by";
  for (std::size_t c = time_columns; c < table.columns.size(); ++c) {
    const SampleColumn& column = table.columns[c];
    if (!wanted(column)) continue;
    names += ',' + column.name;
    if (!column.unit.empty()) out += "; " + column.name + ' ' + column.unit;
  }
  out += '\n' + names + '\n';

  const std::vector<ClockLine> lines = clock_lines(session, stream);
  std::size_t line = 0, reading = 0;
  for (std::size_t i = 0; i < stream.samples.size(); ++i) {
    const Sample sample = sample_at(session, stream, i);
    const SampleTime& time = time_of(sample);
    append(out, time.host);
    out += ',';
    std::optional<Timestamp> fitted;
    if (time.device_tick) {
      append_number(out, *time.device_tick);
      while (line + 1 < lines.size() && lines[line + 1].first_reading <= reading) ++line;
      if (line < lines.size()) fitted = lines[line].host(*time.device_tick, time.host);
      ++reading;
    }
    out += ',';
    append_number(out, time.sequence);
    out += ',';
    if (fitted) append(out, *fitted);
    out += valid(sample) ? ",1," : ",0,";
    out += word_for(time.stamped_by);
    for (std::size_t c = time_columns; c < table.columns.size(); ++c) {
      if (!wanted(table.columns[c])) continue;
      out += ',';
      append(out, table.columns[c].get(sample));
    }
    out += '\n';
  }
  return out;
}

Result<std::vector<Timestamp>> read_times(std::string_view text) {
  std::vector<Timestamp> times;
  CsvRows rows(text);
  auto column = rows.column("host_s");
  if (!column) column = rows.column("t_s");
  if (column) {
    for (std::size_t row = 1; rows.next(); ++row) {
      const auto time = rows.seconds(*column);
      if (!time)
        return failure(Fault::malformed,
                       "row " + std::to_string(row) + " has no time in seconds; mend or remove it");
      times.emplace_back(*time);
    }
    return times;
  }
  for (std::size_t line = 1; !text.empty(); ++line) {
    std::string_view rest = take_line(text);
    const std::string_view field = take_field(rest = rest.substr(0, rest.find(',')));
    if (field.empty() || field.front() == '#') continue;
    const auto time = any_seconds(field);
    if (!time)
      return failure(Fault::malformed,
                     "line " + std::to_string(line) +
                         " is no time in seconds; give a column host_s or t_s, or times alone");
    times.emplace_back(*time);
  }
  return times;
}

Result<std::string> poses_at(const Session& session, const SessionStream& stream,
                             const std::vector<Timestamp>& times, Duration longest_span) {
  if (!std::holds_alternative<PoseSample>(sample_tables()[stream.kind].blank))
    return failure(Fault::usage, "'" + stream.name + "' holds no poses; --at is for trackers");
  PoseHistory history({.samples = stream.samples.size() + 1, .longest_span = longest_span});
  for (std::size_t i = 0; i < stream.samples.size(); ++i)
    history.add(std::get<PoseSample>(sample_at(session, stream, i)));
  std::string out = "# host_s s; x_m m; y_m m; z_m m\nhost_s,how,qw,qx,qy,qz,x_m,y_m,z_m\n";
  for (const Timestamp time : times) {
    const PoseAnswer answer = history.at(time);
    append(out, time);
    out += ',';
    out += word_for(answer.origin);
    const Eigen::Quaterniond& q = answer.tracker_from_tool.rotation;
    const Eigen::Vector3d& t = answer.tracker_from_tool.translation;
    for (const double number : {q.w(), q.x(), q.y(), q.z(), t.x(), t.y(), t.z()}) {
      out += ',';
      if (answer.origin != PoseOrigin::none) append_number(out, number);
    }
    out += '\n';
  }
  return out;
}

}  // namespace fude
