#include "capture/import/poses_csv.h"

#include <array>
#include <cmath>

#include "capture/import/csv_rows.h"
#include "capture/import/row_clock.h"

namespace fude {
namespace {

constexpr double rotation_tolerance = 0.02;

struct ToolColumns {
  std::string name;
  bool matrix = false;
  std::array<std::size_t, 12> at{};  // m00 … m23, or q then position in the first seven
  std::optional<std::size_t> ok;
};

// Tools in the order of their first column.
std::vector<ToolColumns> tools_of(const CsvRows& rows) {
  constexpr std::array<const char*, 7> parts{"_qw", "_qx", "_qy", "_qz", "_x", "_y", "_z"};
  std::vector<ToolColumns> tools;
  for (const std::string_view first : rows.names()) {
    const bool matrix = first.ends_with("_m00");
    if (!matrix && !first.ends_with("_qw")) continue;
    ToolColumns tool{.name = std::string(first.substr(0, first.size() - (matrix ? 4 : 3))), .matrix = matrix};
    bool whole = !tool.name.empty() && tool.name.size() <= 256;
    for (std::size_t i = 0; i < (matrix ? 12U : parts.size()); ++i) {
      const std::string part = matrix ? "_m" + std::to_string(i / 4) + std::to_string(i % 4) : parts[i];
      const auto column = rows.column(tool.name + part);
      whole = whole && column;
      tool.at[i] = column.value_or(0);
    }
    tool.ok = rows.column(tool.name + "_ok");
    if (whole) tools.push_back(std::move(tool));
  }
  return tools;
}

// None where the numbers are not those of a pose.
std::optional<Pose<Tracker, Tool>> pose_from(const std::array<double, 12>& v, bool matrix, double unit) {
  if (!matrix) {
    const Eigen::Quaterniond q(v[0], v[1], v[2], v[3]);
    if (!(std::abs(q.norm() - 1) < rotation_tolerance)) return std::nullopt;
    return Pose<Tracker, Tool>{q.normalized(), unit * Eigen::Vector3d(v[4], v[5], v[6])};
  }
  Eigen::Matrix3d r;
  r << v[0], v[1], v[2], v[4], v[5], v[6], v[8], v[9], v[10];
  if (!((r * r.transpose() - Eigen::Matrix3d::Identity()).norm() < rotation_tolerance) || r.determinant() < 0)
    return std::nullopt;
  return Pose<Tracker, Tool>{Eigen::Quaterniond(r).normalized(), unit * Eigen::Vector3d(v[3], v[7], v[11])};
}

}  // namespace

bool looks_like_poses_csv(std::string_view text) { return !tools_of(CsvRows(text)).empty(); }

Result<RawRecording> import_poses_csv(std::string_view text, const PosesOptions& options) {
  CsvRows rows(text);
  const std::vector<ToolColumns> tools = tools_of(rows);
  if (tools.empty())
    return failure(
        Fault::malformed,
        "the table has no whole pose: a tool NAME needs NAME_m00 … NAME_m23, or NAME_qw … NAME_qz and "
        "NAME_x … NAME_z");
  RawRecording recording;
  recording.device = DeviceDescription{
      .id = "text:poses-csv", .name = "tracker", .kind = DeviceKind::tracker, .transport = "text"};
  RowClock clock(rows, options.rate_hz);
  if (auto sound = clock.check(); !sound) return tl::unexpected(sound.error());
  if (clock.ticks()) recording.device->clock = DeviceClock{};
  while (rows.next()) {
    ++recording.counts.events;
    const auto time = clock.time(rows, recording);
    if (!time) continue;
    for (const ToolColumns& tool : tools) {
      std::array<double, 12> values{};
      bool numbers = true;
      for (std::size_t i = 0; i < (tool.matrix ? 12U : 7U); ++i) {
        const auto value = rows.real(tool.at[i]);
        numbers = numbers && value;
        values[i] = value.value_or(0);
      }
      if (!numbers) {
        ++recording.passed_over["poses of " + tool.name + " without all their numbers"];
        continue;
      }
      PoseSample sample{.time = *time, .tool = tool.name};
      const auto pose = pose_from(values, tool.matrix, options.metres_per_unit);
      const bool seen = !tool.ok || rows.real(*tool.ok).value_or(0) != 0;
      sample.valid = seen && pose && pose->translation.allFinite();
      if (seen && !pose)
        ++recording.passed_over["poses of " + tool.name + " that are no rotation, kept as not valid"];
      if (pose && pose->translation.allFinite()) sample.tracker_from_tool = *pose;
      if (!sample.valid) sample.origin = PoseOrigin::none;
      recording.samples.emplace_back(std::move(sample));
    }
  }
  recording.counts.ignored_lines = rows.ignored();
  if (recording.samples.empty())
    return failure(Fault::malformed, "no row of the table can be read; check its numbers and its time");
  return recording;
}

}  // namespace fude
