#include "capture/import/imu_csv.h"

#include <array>
#include <cmath>

#include "capture/import/csv_rows.h"
#include "capture/import/row_clock.h"

namespace fude {
namespace {

using Columns = std::array<std::size_t, 3>;

std::optional<Columns> columns(const CsvRows& rows, const char* quantity, const char* unit) {
  Columns found{};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto at = rows.column(std::string(quantity) + '_' + "xyz"[i] + '_' + unit);
    if (!at) return std::nullopt;
    found[i] = *at;
  }
  return found;
}

// None where a field is no number; nan stays.
std::optional<Eigen::Vector3d> vector(const CsvRows& rows, const Columns& at) {
  Eigen::Vector3d v;
  for (int i = 0; i < 3; ++i) {
    const auto value = rows.real(at[static_cast<std::size_t>(i)]);
    if (!value) return std::nullopt;
    v[i] = *value;
  }
  return v;
}

}  // namespace

bool looks_like_imu_csv(std::string_view text) {
  const CsvRows rows(text);
  return columns(rows, "gyr", "radps") && columns(rows, "acc", "mps2");
}

Result<std::vector<RawRecording>> import_imu_csv(std::string_view text, std::optional<double> rate_hz) {
  CsvRows rows(text);
  const auto turn = columns(rows, "gyr", "radps"), force = columns(rows, "acc", "mps2");
  if (!turn || !force)
    return failure(
        Fault::malformed,
        "the table lacks gyr_x_radps … gyr_z_radps or acc_x_mps2 … acc_z_mps2; name them in its first row");
  const auto field = columns(rows, "mag", "uT"), place = columns(rows, "opt", "m");
  std::array<std::optional<std::size_t>, 4> quaternion;
  for (std::size_t i = 0; i < 4; ++i) quaternion[i] = rows.column(std::string("opt_q") + "wxyz"[i]);
  const bool optical = quaternion[0] && quaternion[1] && quaternion[2] && quaternion[3];
  const auto movement = rows.column("movement");

  std::vector<RawRecording> recordings(optical ? 2 : 1);
  RawRecording& imu = recordings[0];
  imu.device =
      DeviceDescription{.id = "text:imu-csv", .name = "imu", .kind = DeviceKind::imu, .transport = "text"};
  if (optical)
    recordings[1].device = DeviceDescription{
        .id = "text:imu-csv", .name = "optical", .kind = DeviceKind::tracker, .transport = "text"};
  RowClock clock(rows, rate_hz);
  if (auto sound = clock.check(); !sound) return tl::unexpected(sound.error());
  while (rows.next()) {
    ++imu.counts.events;
    const auto rate = vector(rows, *turn), acceleration = vector(rows, *force);
    const auto time = clock.time(rows, imu);
    if (!time) continue;
    if (!rate || !acceleration) {
      ++imu.passed_over["rows without all their numbers"];
      continue;
    }
    const std::uint32_t moves = movement && rows.real(*movement).value_or(0) != 0 ? 1 : 0;
    ImuSample sample{.time = *time, .turn_rate_radps = *rate, .specific_force_mps2 = *acceleration};
    if (field) sample.magnetic_field_ut = vector(rows, *field);
    sample.buttons = moves;
    if (!rate->allFinite() || !acceleration->allFinite()) {
      sample.valid = false;
      sample.turn_rate_radps = sample.specific_force_mps2 = Eigen::Vector3d::Zero();
    }
    if (sample.magnetic_field_ut && !sample.magnetic_field_ut->allFinite()) sample.magnetic_field_ut.reset();
    imu.samples.emplace_back(sample);
    if (!optical) continue;
    PoseSample pose{.time = *time, .tool = "sensor", .buttons = moves};
    Eigen::Vector4d q;
    for (std::size_t i = 0; i < 4; ++i)
      q[static_cast<Eigen::Index>(i)] = rows.real(*quaternion[i]).value_or(std::nan(""));
    const Eigen::Vector3d at = place ? vector(rows, *place).value_or(Eigen::Vector3d::Constant(std::nan("")))
                                     : Eigen::Vector3d::Zero();
    pose.valid = q.allFinite() && at.allFinite() && std::abs(q.norm() - 1) < 0.01;
    if (pose.valid)
      pose.tracker_from_tool = {Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized(), at};
    else
      pose.origin = PoseOrigin::none;
    recordings[1].samples.emplace_back(pose);
  }
  imu.counts.ignored_lines = rows.ignored();
  if (imu.samples.empty())
    return failure(Fault::malformed, "no row of the table can be read; check its numbers and its time");
  return recordings;
}

}  // namespace fude
