#include "rig/fusion/fuse_orientation.h"

#include <cmath>
#include <optional>

#include "calibration/fusion/smoother.h"

namespace fude {
namespace {

// Turn rates alone: from where the sensor stood at first.
class GyroOnly {
 public:
  void add(const InertialReading& reading, double step_s) {
    q_ = (q_ * rotation_of(reading.turn_rate_radps * step_s)).normalized();
    sigma_ += OrientationSettings{}.start_bias_radps * step_s;
  }
  FusedRow row(Timestamp time) const {
    FusedRow row{.time = time, .state = FusionState::ok, .world_from_sensor = q_};
    row.covariance.diagonal().tail<3>().setConstant(sigma_ * sigma_);
    return row;
  }

 private:
  Eigen::Quaterniond q_ = Eigen::Quaterniond::Identity();
  double sigma_ = 0;
};

}  // namespace

FusedSession fuse_orientation(const std::vector<UsableSample>& samples, const std::set<FuseSource>& use,
                              bool smooth) {
  FusedSession fused;
  OrientationSettings settings;
  if (!use.contains(FuseSource::gyro)) settings.force_time_s = 0.2;  // nothing else follows a turn
  OrientationFilter filter(settings);
  GyroOnly gyro;
  const bool alone = !use.contains(FuseSource::accel);
  std::vector<OrientationInput> inputs;
  std::vector<std::size_t> input_rows;
  LeapWatch leap_watch;
  std::optional<Timestamp> last_good;
  for (const UsableSample& sample : samples) {
    const auto& imu = std::get<ImuSample>(sample.what);
    const double step = last_good ? seconds(sample.time - *last_good) : settings.longest_step_s / 100;
    const InertialReading reading = reading_of(imu, use);
    const bool believed = !last_good || leap_watch.believes(*last_good, sample.time);
    const bool good =
        imu.valid && believed && (alone ? step > 0 && plausible(reading) : filter.add(reading, step));
    if (good) {
      if (alone && last_good) gyro.add(reading, step);
      last_good = sample.time;
      ++fused.counts.inertial;
      inputs.push_back({sample.time, reading});
      input_rows.push_back(fused.rows.size());
    } else {
      ++(!believed                ? fused.lateness.leaps
         : imu.valid && step <= 0 ? fused.counts.repeated
                                  : fused.counts.unsound);
    }
    FusedRow row{.time = sample.stamped};
    if (last_good && alone) {
      row = gyro.row(sample.stamped);
    } else if (last_good) {
      row.world_from_sensor = filter.earth_from_sensor();
      row.covariance.diagonal().tail<3>() = filter.variance();
    }
    const double silence = last_good ? std::abs(seconds(sample.time - *last_good)) : 1e9;
    row.state = silence <= 0.05  ? FusionState::ok
                : silence <= 1.0 ? FusionState::predicted
                                 : FusionState::lost;
    fused.rows.push_back(row);
  }
  if (smooth && !alone) {
    const std::vector<Eigen::Quaterniond> middle = smooth_orientation(inputs, settings);
    for (std::size_t i = 0; i < middle.size(); ++i) fused.rows[input_rows[i]].world_from_sensor = middle[i];
  }
  return fused;
}

}  // namespace fude
