#include "capture/import/svc.h"

#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "capture/import/pen_lean.h"
#include "capture/import/text_fields.h"

namespace fude {
namespace {

constexpr double farthest_mm = 1e5;
constexpr double tenth_of_degree = std::numbers::pi / 1800;

enum Field { x, y, t, status, azimuth, altitude, pressure, fields };
using Row = std::array<double, fields>;

std::string_view first_content(std::string_view& text) {
  while (!text.empty()) {
    std::string_view line = take_line(text);
    if (line.find_first_not_of(" \t") != std::string_view::npos) return line;
  }
  return {};
}

std::optional<std::uint64_t> stated_rows(std::string_view line) {
  const auto number = whole_integer<std::uint64_t>(take_field(line));
  return take_field(line).empty() ? number : std::nullopt;
}

std::optional<Row> read_row(std::string_view line) {
  Row row{};
  for (double& value : row) {
    const auto number = whole_real(take_field(line));
    if (!number) return std::nullopt;
    value = *number;
  }
  return take_field(line).empty() ? std::optional(row) : std::nullopt;
}

// Why a row cannot be used; null where it can. Not-a-number fails every comparison.
const char* complaint(const Row& row) {
  if (!(row[t] >= 0 && row[t] < longest_time_s)) return "rows without a time";
  if (!(std::abs(row[x]) <= farthest_mm && std::abs(row[y]) <= farthest_mm))
    return "rows beyond a hundred metres";
  if (!(row[pressure] >= 0 && row[pressure] <= 1)) return "rows whose pressure is not between 0 and 1";
  if (row[status] != 0 && row[status] != 1) return "rows whose pen is neither down nor hovering";
  return nullptr;
}

}  // namespace

bool looks_like_svc(std::string_view text) {
  if (!stated_rows(first_content(text))) return false;
  return read_row(first_content(text)).has_value();
}

Result<RawRecording> import_svc(std::string_view text) {
  const auto stated = stated_rows(first_content(text));
  if (!stated)
    return failure(Fault::malformed, "the first line is not the number of rows; is this an .svc file?");
  RawRecording recording;
  DeviceDescription& device = recording.device.emplace();
  device.id = "text:svc";
  device.name = "handwriting in millimetres";
  device.kind = DeviceKind::pen_tablet;
  device.transport = "text";
  device.mm_per_count = 1;
  std::optional<Timestamp> before;
  while (!text.empty()) {
    const std::string_view line = take_line(text);
    if (line.find_first_not_of(" \t") == std::string_view::npos) {
      ++recording.counts.ignored_lines;
      continue;
    }
    const std::uint64_t number = recording.counts.events++;
    const auto row = read_row(line);
    const char* wrong = row ? complaint(*row) : "lines that are not seven numbers";
    const Timestamp time(row ? Duration(std::llround((*row)[t] * 1e9)) : Duration{});
    if (wrong == nullptr && before && time < *before) wrong = "rows whose time runs backwards";
    if (wrong != nullptr) {
      ++recording.passed_over[wrong];
      continue;
    }
    if (before && time == *before) ++recording.counts.still_times;
    before = time;
    PenSample pen{.time = {time, StampedBy::recording, number, std::nullopt}, .tool = PenTool::pen};
    pen.in_proximity = true;
    pen.in_contact = (*row)[status] == 1;
    pen.x_counts = (*row)[x];
    pen.y_counts = (*row)[y];
    pen.pressure = Fraction((*row)[pressure]);
    if (const double up = (*row)[altitude]; up >= 0 && up <= 900 && std::abs((*row)[azimuth]) <= 3600)
      lean_by(pen, up * tenth_of_degree, (*row)[azimuth] * tenth_of_degree);
    else
      ++recording.passed_over["leans that are no angles"];
    recording.samples.emplace_back(pen);
  }
  if (recording.samples.empty())
    return failure(Fault::malformed, "no row can be read as x, y, t, status, azimuth, altitude, pressure");
  if (recording.counts.events != *stated)
    recording.passed_over["stated rows that are not there, or rows beyond the stated"] =
        *stated > recording.counts.events ? *stated - recording.counts.events
                                          : recording.counts.events - *stated;
  return recording;
}

}  // namespace fude
