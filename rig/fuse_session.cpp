#include "rig/fuse_session.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <variant>

#include "calibration/fusion/smoother.h"
#include "drivers/ultrasonic/multilateration.h"
#include "rig/fix_of.h"
#include "rig/fuse_geometry.h"

namespace fude {
namespace {

constexpr std::array<std::pair<std::string_view, FuseSource>, 9> source_names{{
    {"gyro", FuseSource::gyro},
    {"accel", FuseSource::accel},
    {"mag", FuseSource::mag},
    {"pose", FuseSource::pose},
    {"position", FuseSource::position},
    {"range", FuseSource::range},
    {"contact", FuseSource::contact},
    {"opt_pose", FuseSource::opt_pose},
    {"opt_position", FuseSource::opt_position},
}};

// A tracker that stands for the truth of an inertial recording: never used unless named.
bool is_truth(const DeviceDescription& device) {
  return device.kind == DeviceKind::tracker && device.id == "text:imu-csv";
}

bool says_where(FuseSource source) { return source >= FuseSource::pose; }

// A sample that may be used, of whichever kind.
struct Taken {
  Timestamp time{};
  std::variant<ImuSample, Fix> what;
};

class Collection {
 public:
  Collection(const Session& session, const FuseGeometry& geometry) : geometry_(geometry) {
    for (const RecordedDevice& device : session.devices) truth_[device.number] = is_truth(device.description);
    for (const RecordedSample& sample : session.samples)
      std::visit([&](const auto& s) { take(sample.device, s); }, sample.sample);
    for (const RecordedPen& pen : session.pens)
      if (pen.sample.in_contact && geometry.tip_m)
        keep(FuseSource::contact, pen.sample.time.host, ContactFix{.tip_offset_m = *geometry.tip_m});
  }

  bool has(FuseSource source) const { return found_.contains(source); }

  std::vector<Taken> of(const std::set<FuseSource>& use) const {
    std::vector<Taken> chosen;
    const bool inertial = use.contains(FuseSource::gyro) || use.contains(FuseSource::accel);
    for (const auto& [source, taken] : samples_)
      if (source ? use.contains(*source) : inertial) chosen.push_back(taken);
    return chosen;
  }

 private:
  void keep(FuseSource source, Timestamp time, const Fix& fix) {
    found_.insert(source);
    samples_.push_back({source, {time, fix}});
  }

  void take(DeviceNumber device, const ImuSample& sample) {
    if (imu_ && *imu_ != device) return;
    imu_ = device;
    found_.insert(FuseSource::gyro);
    found_.insert(FuseSource::accel);
    if (sample.magnetic_field_ut) found_.insert(FuseSource::mag);
    samples_.push_back({std::nullopt, {sample.time.host, sample}});
  }

  void take(DeviceNumber device, const PoseSample& sample) {
    if (!sample.valid || !mine(device, sample.tool)) return;
    const PoseFix pose = fix_of(sample);
    const bool truth = truth_[device];
    keep(truth ? FuseSource::opt_pose : FuseSource::pose, sample.time.host, pose);
    keep(truth ? FuseSource::opt_position : FuseSource::position, sample.time.host, point_of(pose));
  }

  void take(DeviceNumber device, const PositionSample& sample) {
    if (!sample.valid || !mine(device, sample.marker)) return;
    keep(truth_[device] ? FuseSource::opt_position : FuseSource::position, sample.time.host, fix_of(sample));
  }

  void take(DeviceNumber, const RangeSample& sample) {
    if (!geometry_.emitter_m) return;
    const double speed = ultrasonic::speed_of_sound_mps(sample.temperature_c.value_or(20));
    for (std::size_t i = 0; i < std::min(geometry_.receivers_m.size(), sample.flight_s.size()); ++i)
      if (sample.flight_s[i])
        keep(FuseSource::range, sample.time.host,
             RangeFix{.receiver_m = geometry_.receivers_m[i],
                      .emitter_offset_m = *geometry_.emitter_m,
                      .distance_m = speed * *sample.flight_s[i]});
  }

  template <class Other>
  void take(DeviceNumber, const Other&) {}

  // One tool of one tracker is the brush, and one of the truth.
  bool mine(DeviceNumber device, const std::string& part) {
    auto& tool = tool_[truth_[device]];
    if (!tool) tool.emplace(device, part);
    return *tool == std::pair(device, part);
  }

  const FuseGeometry& geometry_;
  std::map<DeviceNumber, bool> truth_;
  std::array<std::optional<std::pair<DeviceNumber, std::string>>, 2> tool_;
  std::optional<DeviceNumber> imu_;
  std::set<FuseSource> found_;
  std::vector<std::pair<std::optional<FuseSource>, Taken>> samples_;  // none: inertial
};

InertialReading reading_of(const ImuSample& imu, const std::set<FuseSource>& use) {
  InertialReading reading{imu.turn_rate_radps, imu.specific_force_mps2, imu.magnetic_field_ut};
  if (!use.contains(FuseSource::gyro)) reading.turn_rate_radps.setZero();
  if (!use.contains(FuseSource::mag)) reading.magnetic_field_ut.reset();
  return reading;
}

FusedRow row_of(const FusedPose& pose, Timestamp time) {
  FusedRow row{.time = time, .state = pose.state, .world_from_sensor = pose.world_from_sensor};
  if (pose.state != FusionState::lost) row.position_m = pose.point_m;
  row.variance = pose.covariance.diagonal();
  return row;
}

// Turn rates alone: from where the sensor stood at first.
class GyroOnly {
 public:
  void add(const InertialReading& reading, double step_s) {
    q_ = (q_ * rotation_of(reading.turn_rate_radps * step_s)).normalized();
    sigma_ += OrientationSettings{}.start_bias_radps * step_s;
  }
  FusedRow row(Timestamp time) const {
    FusedRow row{.time = time, .state = FusionState::ok, .world_from_sensor = q_};
    row.variance.tail<3>().setConstant(sigma_ * sigma_);
    return row;
  }

 private:
  Eigen::Quaterniond q_ = Eigen::Quaterniond::Identity();
  double sigma_ = 0;
};

FusedSession orientation_alone(const std::vector<Taken>& samples, const std::set<FuseSource>& use,
                               bool smooth) {
  FusedSession fused;
  OrientationSettings settings;
  if (!use.contains(FuseSource::gyro)) settings.force_time_s = 0.2;  // nothing else follows a turn
  OrientationFilter filter(settings);
  GyroOnly gyro;
  const bool alone = !use.contains(FuseSource::accel);
  std::vector<OrientationInput> inputs;
  std::vector<std::size_t> input_rows;
  std::optional<Timestamp> last, last_good;
  for (const Taken& sample : samples) {
    const auto& imu = std::get<ImuSample>(sample.what);
    const double step = last_good ? seconds(sample.time - *last_good) : settings.longest_step_s / 100;
    const InertialReading reading = reading_of(imu, use);
    const bool good = imu.valid && (alone ? step > 0 : filter.add(reading, step));
    if (good) {
      if (alone && last_good) gyro.add(reading, step);
      last_good = sample.time;
      ++fused.counts.inertial;
      inputs.push_back({sample.time, reading});
      input_rows.push_back(fused.rows.size());
    } else {
      ++(imu.valid ? fused.counts.repeated : fused.counts.unsound);
    }
    FusedRow row{.time = sample.time};
    if (last_good && alone) {
      row = gyro.row(sample.time);
    } else if (last_good) {
      row.world_from_sensor = filter.earth_from_sensor();
      row.variance.tail<3>() = filter.variance();
    }
    const double silence = last_good ? seconds(sample.time - *last_good) : 1e9;
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

FusedSession fuse(const std::vector<Taken>& samples, const std::set<FuseSource>& use, bool inertial,
                  const FuseWish& wish) {
  FusedSession fused;
  // Where north lies in a tracker's frame nobody knows; the truth's frame is earth.
  const bool earth = use.contains(FuseSource::opt_pose) || use.contains(FuseSource::opt_position);
  const FusionSettings settings = fusion_settings(wish.up, inertial, earth && use.contains(FuseSource::mag));
  Fusion fusion(settings);
  std::vector<FusionInput> inputs;
  for (const Taken& sample : samples) {
    if (const auto* imu = std::get_if<ImuSample>(&sample.what)) {
      const InertialReading reading = reading_of(*imu, use);
      if (imu->valid) {
        fusion.add(reading, sample.time);
        if (wish.smooth) inputs.push_back({sample.time, reading});
      }
    } else {
      fusion.add(std::get<Fix>(sample.what), sample.time);
      if (wish.smooth) inputs.push_back({sample.time, std::get<Fix>(sample.what)});
      if (inertial) continue;
    }
    fused.rows.push_back(row_of(fusion.pose(), sample.time));
  }
  fused.counts = fusion.counts();
  fused.lateness = fusion.lateness();
  if (!wish.smooth) return fused;
  std::stable_sort(inputs.begin(), inputs.end(),
                   [](const FusionInput& a, const FusionInput& b) { return a.time < b.time; });
  const std::vector<FusedPose> smoothed = smooth(inputs, settings);
  std::size_t next = 0;
  for (FusedRow& row : fused.rows) {
    while (next < smoothed.size() && smoothed[next].time < row.time) ++next;
    if (next < smoothed.size() && smoothed[next].time == row.time) row = row_of(smoothed[next], row.time);
  }
  return fused;
}

const char* name_of(FusionState state) {
  return state == FusionState::ok ? "OK" : state == FusionState::predicted ? "PREDICTED" : "LOST";
}

}  // namespace

Result<std::set<FuseSource>> fuse_sources(std::string_view names) {
  std::set<FuseSource> sources;
  while (!names.empty()) {
    const std::string_view name = names.substr(0, names.find(','));
    names.remove_prefix(std::min(names.size(), name.size() + 1));
    if (name == "imu") {
      sources.insert({FuseSource::gyro, FuseSource::accel, FuseSource::mag});
      continue;
    }
    const auto found = std::find_if(source_names.begin(), source_names.end(),
                                    [&](const auto& known) { return known.first == name; });
    if (found == source_names.end())
      return failure(Fault::usage,
                     "there is no source \"" + std::string(name) +
                         "\"; name some of imu, gyro, accel, mag, pose, position, range, contact, "
                         "opt_pose, opt_position, with a comma between them");
    sources.insert(found->second);
  }
  if (sources.empty()) return failure(Fault::usage, "--use names no source");
  return sources;
}

Result<FusedSession> fuse_session(const Session& session, const FuseWish& wish) {
  const auto geometry = fuse_geometry(session);
  if (!geometry) return tl::unexpected(geometry.error());
  const Collection collection(session, *geometry);
  std::set<FuseSource> use;
  for (const auto& [name, source] : source_names) {
    const bool optional = source == FuseSource::opt_pose || source == FuseSource::opt_position;
    const bool named = wish.use && wish.use->contains(source);
    if (named && !collection.has(source) && source != FuseSource::mag)
      return failure(Fault::usage,
                     "the session holds no " + std::string(name) +
                         " that could be used; see `fude info`, and docs/fusion.md for what each needs");
    if (collection.has(source) && (wish.use ? named : !optional)) use.insert(source);
  }
  // A pose says the position too.
  if (use.contains(FuseSource::pose)) use.erase(FuseSource::position);
  if (use.contains(FuseSource::opt_pose)) use.erase(FuseSource::opt_position);
  if (use.empty())
    return failure(Fault::not_found, "the session holds no inertial samples, poses or positions to fuse");
  const bool placed = std::any_of(use.begin(), use.end(), says_where);
  const bool gyro = use.contains(FuseSource::gyro), accel = use.contains(FuseSource::accel);
  if (use.contains(FuseSource::mag) && !accel)
    return failure(Fault::usage, "mag needs accel beside it, which says what is level");
  if (placed && gyro != accel)
    return failure(Fault::usage, "with positions, gyro and accel are used together or not at all");
  const std::vector<Taken> samples = collection.of(use);
  return placed ? fuse(samples, use, gyro, wish) : orientation_alone(samples, use, wish.smooth);
}

std::string csv_of(const FusedSession& fused) {
  std::string text = "t_s,x_m,y_m,z_m,qw,qx,qy,qz,var_0,var_1,var_2,var_3,var_4,var_5,state\n";
  char field[40];
  const auto number = [&](double value, const char* format) {
    std::snprintf(field, sizeof field, format, value);
    text += ',';
    text += field;
  };
  for (const FusedRow& row : fused.rows) {
    const auto ns = row.time.time_since_epoch().count();
    std::snprintf(field, sizeof field, "%s%lld.%09lld", ns < 0 ? "-" : "",
                  static_cast<long long>(std::abs(ns) / 1'000'000'000),
                  static_cast<long long>(std::abs(ns) % 1'000'000'000));
    text += field;
    if (row.position_m)
      for (int i = 0; i < 3; ++i) number((*row.position_m)[i], "%.7f");
    else
      text += ",,,";
    const auto& q = row.world_from_sensor;
    if (q)
      for (const double part : {q->w(), q->x(), q->y(), q->z()}) number(part, "%.9f");
    else
      text += ",,,,";
    for (int i = 0; i < 6; ++i) {
      if (i < 3 ? row.position_m.has_value() : q.has_value())
        number(row.variance[i], "%.6g");
      else
        text += ',';
    }
    text += ',';
    text += name_of(row.state);
    text += '\n';
  }
  return text;
}

}  // namespace fude
