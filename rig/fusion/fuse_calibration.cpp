#include "rig/fusion/fuse_calibration.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "calibration/sensor_axes.h"
#include "capture/streams.h"
#include "rig/calibration/calibration_file.h"
#include "rig/calibration/made_with.h"
#include "rig/session_identity.h"

namespace fude {
namespace {

// The tool whose poses are fused: the first that was seen.
std::string tool_of(const Session& session) {
  for (const RecordedSample& sample : session.samples)
    if (const auto* pose = std::get_if<PoseSample>(&sample.sample); pose != nullptr && pose->valid)
      return pose->tool;
  return {};
}

CalibratedHere here(const Session& session) {
  CalibratedHere here{{}, tool_of(session), {}};
  for (const RecordedDevice& device : session.devices) here.devices.push_back(device.description.id);
  return here;
}

class Applying {
 public:
  Applying(const Session& session, FuseCalibration& to) : session_(session), to_(to) {}

  void apply(const std::string& name, const StoredCalibration& calibration) {
    const Fields& fields = calibration.result;
    const std::string& what = calibration.report.procedure;
    if (const auto imu = imu_from(fields)) {
      to_.imu = *imu;
    } else if (const auto axes = sensor_axes_from(fields)) {
      to_.tool_from_sensor = axes->tool_from_sensor;
    } else if (auto distortion = distortion_from(fields)) {
      to_.distortion = std::move(*distortion);
    } else if (const auto surface = surface_from(fields)) {
      const auto& paper = surface->paper_from_tracker;
      to_.paper_from_tracker = {paper.rotation, 1e-3 * paper.translation};
      to_.sheet = surface->sheet ? std::make_shared<const SmoothField>(*surface->sheet) : nullptr;
    } else if (const auto offset = numbers_in(fields, "offset_s"); offset && offset->size() == 1) {
      if (!apply_delay(name, calibration, offset->front())) return;
    } else if (!numbers_in(fields, "tip_m")) {
      return;  // of no use to a fusion
    }
    to_.notes.push_back("applied: " + what + " of " + name);
  }

 private:
  bool apply_delay(const std::string& name, const StoredCalibration& calibration, double offset_s) {
    const Fields& fields = calibration.result;
    const std::string* second = nullptr;
    for (const Field& field : fields)
      if (const auto* words = std::get_if<std::vector<std::string>>(&field.value);
          words != nullptr && field.key == "streams" && words->size() == 2)
        second = &words->back();
    if (second == nullptr || !std::isfinite(offset_s)) {
      to_.notes.push_back("not applied: " + name + " does not name its two streams");
      return false;
    }
    const auto stream = find_stream(session_, *second);
    if (!stream) {
      to_.notes.push_back("not applied: the delay of " + name + ", as the session has no stream " + *second);
      return false;
    }
    StreamDelay delay{.offset_s = offset_s};
    const auto number = [&](const char* key) {
      const auto found = numbers_in(fields, key);
      return found && found->size() == 1 && std::isfinite(found->front()) ? found->front() : 0;
    };
    if (number("drift_ppm") != 0) {
      if (calibration.report.session == session_identity(session_)) {
        delay.drift = 1e-6 * number("drift_ppm");
        delay.reference_s = number("reference_s");
      } else {
        to_.notes.push_back("the drift of " + name + " is of another session and is not applied");
      }
    }
    to_.delays[{stream->device, stream->part}] = delay;
    return true;
  }

  const Session& session_;
  FuseCalibration& to_;
};

}  // namespace

Duration FuseCalibration::delay_of(DeviceNumber device, const std::string& part, Timestamp time) const {
  auto found = delays.find({device, part});
  if (found == delays.end()) found = delays.find({device, ""});
  if (found == delays.end()) return {};
  const StreamDelay& delay = found->second;
  const double since_s = seconds(time.time_since_epoch()) - delay.reference_s;
  return std::chrono::round<Duration>(std::chrono::duration<double>(delay.offset_s + delay.drift * since_s));
}

Duration FuseCalibration::longest_delay() const {
  double longest_s = 0;
  for (const auto& [stream, delay] : delays) longest_s = std::max(longest_s, std::abs(delay.offset_s));
  return std::chrono::round<Duration>(std::chrono::duration<double>(longest_s));
}

Result<FuseCalibration> fuse_calibration(const Session& session,
                                         const std::vector<RecordedCalibration>& named) {
  std::vector<RecordedCalibration> all = session.calibrations;
  all.insert(all.end(), named.begin(), named.end());
  FuseCalibration calibration;
  Applying applying(session, calibration);
  std::vector<RecordedCalibration> ours;
  for (const RecordedCalibration& one : all) {
    if (one.toml.find("procedure") == std::string::npos) {  // places alone, written by hand
      ours.push_back(one);
      continue;
    }
    const auto stored = calibration_from_toml(one.toml, one.name);
    if (!stored) return tl::unexpected(stored.error());
    if (const std::string other = made_otherwise(stored->report, here(session)); !other.empty()) {
      calibration.notes.push_back("not applied: " + one.name + " was made " + other);
      continue;
    }
    applying.apply(one.name, *stored);
    ours.push_back(one);
  }
  auto geometry = fuse_geometry(ours);
  if (!geometry) return tl::unexpected(geometry.error());
  calibration.geometry = std::move(*geometry);
  return calibration;
}

ImuSample put_right(const FuseCalibration& calibration, const ImuSample& sample) {
  ImuSample right = sample;
  if (const auto& imu = calibration.imu) {
    right.turn_rate_radps -= imu->gyro_bias_radps;
    right.specific_force_mps2 =
        imu->accel_scale.cwiseProduct(sample.specific_force_mps2 - imu->accel_bias_mps2);
    if (right.magnetic_field_ut && imu->magnetometer)
      right.magnetic_field_ut =
          imu->magnetometer->shape * (*sample.magnetic_field_ut - imu->magnetometer->offset_ut);
  }
  if (const auto& axes = calibration.tool_from_sensor) {
    right.turn_rate_radps = *axes * right.turn_rate_radps;
    right.specific_force_mps2 = *axes * right.specific_force_mps2;
    if (right.magnetic_field_ut) right.magnetic_field_ut = *axes * *right.magnetic_field_ut;
  }
  return right;
}

}  // namespace fude
