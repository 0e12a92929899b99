#include "capture/import/wacom_ink_csv.h"

#include <cmath>
#include <numbers>
#include <optional>

#include "capture/import/csv_rows.h"
#include "capture/import/pen_lean.h"
#include "capture/import/text_fields.h"

namespace fude {
namespace {

constexpr double farthest_pixel = 1e6;

struct Columns {
  std::size_t stroke, x, y, time_ms, pressure;
  std::optional<std::size_t> start_ms, altitude, azimuth;
};

std::optional<Columns> columns_of(const CsvRows& rows) {
  const auto find = [&](const char* sensor, const char* plain) {
    const auto column = rows.column(sensor);
    return column ? column : rows.column(plain);
  };
  const auto stroke = find("idx", "stroke"), x = find("SPLINE_X", "x_px"), y = find("SPLINE_Y", "y_px"),
             time = find("SENSOR_TIMESTAMP", "t_rel_ms"), pressure = find("SENSOR_PRESSURE", "pressure");
  if (!stroke || !x || !y || !time || !pressure) return std::nullopt;
  return Columns{*stroke,
                 *x,
                 *y,
                 *time,
                 *pressure,
                 rows.column("stroke_t0_unix_ms"),
                 find("SENSOR_ALTITUDE", "altitude_rad"),
                 find("SENSOR_AZIMUTH", "azimuth_rad")};
}

std::optional<Timestamp> time_of_row(const CsvRows& rows, const Columns& at) {
  const auto ms = rows.finite(at.time_ms);
  const auto start = at.start_ms ? rows.finite(*at.start_ms) : std::optional(0.0);
  const auto sound = [](double value) { return value >= 0 && value < longest_time_s * 500; };
  if (!ms || !start || !sound(*start) || !sound(*ms)) return std::nullopt;
  // Whole milliseconds apart: nanoseconds since 1970 are more than a double holds.
  const auto nanoseconds = [](double value) {
    const double whole = std::floor(value);
    return static_cast<std::int64_t>(whole) * 1'000'000 + std::llround((value - whole) * 1e6);
  };
  return Timestamp(Duration(nanoseconds(*start) + nanoseconds(*ms)));
}

}  // namespace

bool looks_like_wacom_ink_csv(std::string_view text) { return columns_of(CsvRows(text)).has_value(); }

Result<RawRecording> import_wacom_ink_csv(std::string_view text, Millimetres per_pixel) {
  if (!(per_pixel.value >= 0.001 && per_pixel.value <= 100))
    return failure(Fault::usage, "--mm-per-px takes 0.001 to 100");
  CsvRows rows(text);
  const auto at = columns_of(rows);
  if (!at)
    return failure(
        Fault::malformed,
        "the table lacks columns of ink: stroke, x_px, y_px, t_rel_ms, pressure, or idx, SPLINE_X …");
  RawRecording recording;
  DeviceDescription& device = recording.device.emplace();
  device.id = "text:wacom-ink-csv";
  device.name = "ink in pixels";
  device.kind = DeviceKind::pen_tablet;
  device.transport = "text";
  device.mm_per_count = per_pixel.value;
  std::string stroke;
  const auto lift = [&] {
    PenSample gone;
    const auto& last = std::get<PenSample>(recording.samples.back());
    gone.time = {last.time.host, StampedBy::recording, last.time.sequence + 1, std::nullopt};
    gone.x_counts = last.x_counts;
    gone.y_counts = last.y_counts;
    recording.samples.emplace_back(gone);
  };
  while (rows.next()) {
    ++recording.counts.events;
    const auto x = rows.finite(at->x), y = rows.finite(at->y), pressure = rows.finite(at->pressure);
    const auto time = time_of_row(rows, *at);
    const char* wrong = nullptr;
    if (!x || !y || !pressure || !time)
      wrong = "rows without all their numbers";
    else if (!(std::abs(*x) <= farthest_pixel && std::abs(*y) <= farthest_pixel))
      wrong = "rows beyond a million pixels";
    else if (!(*pressure >= 0 && *pressure <= 1))
      wrong = "rows whose pressure is not between 0 and 1";
    else if (!recording.samples.empty() && *time < std::get<PenSample>(recording.samples.back()).time.host)
      wrong = "rows whose time runs backwards";
    if (wrong != nullptr) {
      ++recording.passed_over[wrong];
      continue;
    }
    const std::string_view number = rows.text(at->stroke).value_or("");
    if (!recording.samples.empty()) {
      if (number != stroke) lift();
      if (std::get<PenSample>(recording.samples.back()).time.host == *time) ++recording.counts.still_times;
    }
    stroke = number;
    PenSample pen{.time = {*time, StampedBy::recording, recording.samples.size(), std::nullopt},
                  .tool = PenTool::pen};
    pen.in_proximity = pen.in_contact = true;
    pen.x_counts = *x;
    pen.y_counts = *y;
    pen.pressure = Fraction(*pressure);
    const double up = at->altitude ? rows.finite(*at->altitude).value_or(-1) : -1;
    const double around = at->azimuth ? rows.finite(*at->azimuth).value_or(1e9) : 1e9;
    if (up >= 0 && up <= std::numbers::pi / 2 + 1e-6 && std::abs(around) <= 100)
      lean_by(pen, up, around);
    else if (at->altitude && at->azimuth)
      ++recording.passed_over["leans that are no angles"];
    recording.samples.emplace_back(pen);
  }
  recording.counts.ignored_lines = rows.ignored();
  if (recording.samples.empty())
    return failure(Fault::malformed, "no row of the table can be read; check its numbers and its time");
  lift();
  return recording;
}

}  // namespace fude
