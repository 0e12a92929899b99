#include "rig/calibrate_session.h"

#include <algorithm>
#include <chrono>
#include <ctime>

#include "calibration/imu.h"
#include "calibration/landmarks.h"
#include "calibration/pivot.h"
#include "calibration/surface.h"
#include "calibration/touches.h"
#include "capture/session.h"
#include "rig/calibrate_camera.h"
#include "rig/calibration_streams.h"
#include "rig/landmark_file.h"
#include "rig/session_identity.h"

namespace fude {
namespace {

// What every procedure works on.
struct Bench {
  const CalibrationWish& wish;
  const Session& session;
  const std::vector<StoredCalibration>& earlier;
  const OnProgress& on_progress;

  template <class Procedure, class Samples>
  void feed(Procedure& procedure, const Samples& samples) const {
    constexpr std::size_t between_reports = 256;
    std::size_t count = 0;
    for (const auto& sample : samples) {
      const Progress progress = procedure.add(sample);
      if (on_progress && ++count % between_reports == 0) on_progress(progress);
    }
  }
};

template <class T>
CalibrationOutcome outcome_of(Calibration<T> calibration) {
  if (!calibration) return {std::move(calibration.error()), std::nullopt};
  return {std::move(calibration->report), to_fields(calibration->value)};
}

Result<CalibrationOutcome> calibrate_pivot(const Bench& bench) {
  const auto poses = tool_poses(bench.session, bench.wish.tool, bench.wish.reference);
  if (!poses) return tl::unexpected(poses.error());
  PivotProcedure procedure;
  bench.feed(procedure, *poses);
  if (bench.wish.spin) {
    const auto session = read_session(*bench.wish.spin);
    if (!session) return tl::unexpected(session.error());
    const auto spin = tool_poses(*session, bench.wish.tool, bench.wish.reference);
    if (!spin) return tl::unexpected(spin.error());
    procedure.begin_spin();
    bench.feed(procedure, *spin);
  }
  return outcome_of(procedure.finish());
}

// The tip that was named, or that of an earlier pivot.
Result<Eigen::Vector3d> tip_of(const Bench& bench) {
  if (bench.wish.tip_m) return *bench.wish.tip_m;
  for (const StoredCalibration& earlier : bench.earlier)
    if (const auto pivot = pivot_from(earlier.result)) return pivot->tip_m;
  return failure(Fault::usage,
                 bench.wish.procedure + " needs the tip: give --cal PIVOT.toml or --tip-mm x,y,z");
}

Result<CalibrationOutcome> calibrate_surface(const Bench& bench) {
  const auto tip = tip_of(bench);
  if (!tip) return tl::unexpected(tip.error());
  const auto poses = tool_poses(bench.session, bench.wish.tool, bench.wish.reference);
  if (!poses) return tl::unexpected(poses.error());
  SurfaceProcedure procedure(*tip, bench.wish.corners_first);
  bench.feed(procedure, *poses);
  return outcome_of(procedure.finish());
}

// Where the tip touched: each pose, where there are as many as landmarks; else where it rested.
std::vector<Eigen::Vector3d> touched(const std::vector<PoseSample>& poses, const Eigen::Vector3d& tip_m,
                                     std::size_t landmarks) {
  std::vector<TipPoint> way;
  for (const PoseSample& sample : poses)
    if (sample.valid) way.push_back({sample.time.host, sample.tracker_from_tool * tip_m, way.size()});
  if (way.size() != landmarks) way = resting_places(way);
  std::vector<Eigen::Vector3d> points;
  for (const TipPoint& touch : way) points.push_back(touch.point_m);
  return points;
}

Result<CalibrationOutcome> calibrate_tracker(const Bench& bench) {
  if (!bench.wish.landmarks)
    return failure(Fault::usage,
                   "tracker needs --landmarks FILE, a list of name,x,y,z in mm of the reference");
  const auto listed = read_landmarks(*bench.wish.landmarks);
  if (!listed) return tl::unexpected(listed.error());
  std::vector<Eigen::Vector3d> points;
  if (bench.wish.measured) {
    const auto measured = read_landmarks(*bench.wish.measured);
    if (!measured) return tl::unexpected(measured.error());
    points = in_order_of(*listed, *measured);
  } else {
    const auto tip = tip_of(bench);
    if (!tip) return tl::unexpected(tip.error());
    const auto poses = tool_poses(bench.session, bench.wish.tool, bench.wish.reference);
    if (!poses) return tl::unexpected(poses.error());
    points = touched(*poses, *tip, listed->size());
  }
  LandmarkProcedure procedure(*listed);
  bench.feed(procedure, points);
  return outcome_of(procedure.finish());
}

Result<CalibrationOutcome> calibrate_imu(const Bench& bench) {
  const auto samples = imu_samples(bench.session, bench.wish.tool);
  if (!samples) return tl::unexpected(samples.error());
  ImuProcedure procedure;
  bench.feed(procedure, *samples);
  return outcome_of(procedure.finish());
}

#ifdef FUDE_VISION
Result<CalibrationOutcome> calibrate_board(const Bench& bench) {
  return calibrate_camera(bench.session, bench.wish.tool, bench.wish.board, bench.on_progress);
}
#endif

using Calibrate = Result<CalibrationOutcome> (*)(const Bench&);
struct NamedProcedure {
  std::string_view name;
  Calibrate calibrate;
};
constexpr NamedProcedure procedures[] = {
#ifdef FUDE_VISION
    {"camera", calibrate_board},
#endif
    {"pivot", calibrate_pivot},
    {"surface", calibrate_surface},
    {"tracker", calibrate_tracker},
    {"imu", calibrate_imu}};

std::string now_utc() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm parts{};
  gmtime_r(&now, &parts);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text;
}

bool anonymous(std::string_view device) { return device.empty() || device.starts_with("text:"); }

// An earlier calibration counts for the devices it was made with; a table of numbers does not say which.
Result<void> check_devices(const CalibrationWish& wish, const std::vector<StoredCalibration>& earlier,
                           const std::vector<std::string>& devices) {
  for (std::size_t i = 0; i < earlier.size(); ++i) {
    const std::vector<std::string>& made_with = earlier[i].report.devices;
    const auto here = [&](const std::string& device) {
      return anonymous(device) || std::find(devices.begin(), devices.end(), device) != devices.end();
    };
    if (std::any_of(devices.begin(), devices.end(), anonymous)) continue;
    if (const auto other = std::find_if_not(made_with.begin(), made_with.end(), here);
        other != made_with.end())
      return failure(Fault::malformed, wish.earlier[i].string() + " was made with the device " + *other +
                                           ", which is not in this session; calibrate this one");
  }
  return {};
}

}  // namespace

std::span<const std::string_view> calibration_procedures() {
  static const std::vector<std::string_view> names = [] {
    std::vector<std::string_view> all;
    for (const NamedProcedure& p : procedures) all.push_back(p.name);
    return all;
  }();
  return names;
}

Result<CalibrationOutcome> calibrate_session(const CalibrationWish& wish, const OnProgress& on_progress) {
  const auto* procedure = std::find_if(std::begin(procedures), std::end(procedures),
                                       [&](const NamedProcedure& p) { return p.name == wish.procedure; });
  if (procedure == std::end(procedures))
    return failure(Fault::usage, "there is no calibration '" + wish.procedure + "'");
  const bool from_lists = wish.measured && wish.session.empty();
  if (!from_lists && wish.session.empty())
    return failure(Fault::usage,
                   "give the session of the motions: fude calibrate " + wish.procedure + " SESSION");
  const auto session = from_lists ? Result<Session>(Session{}) : read_session(wish.session);
  if (!session) return tl::unexpected(session.error());
  std::vector<std::string> devices;
  for (const RecordedDevice& device : session->devices) devices.push_back(device.description.id);
  std::vector<StoredCalibration> earlier;
  for (const std::filesystem::path& file : wish.earlier) {
    auto calibration = read_calibration(file);
    if (!calibration) return tl::unexpected(calibration.error());
    earlier.push_back(std::move(*calibration));
  }
  if (auto sound = check_devices(wish, earlier, devices); !sound) return tl::unexpected(sound.error());
  auto outcome = procedure->calibrate({wish, *session, earlier, on_progress});
  if (!outcome) return outcome;
  outcome->report.date = now_utc();
  outcome->report.devices = devices;
  if (!from_lists) outcome->report.session = session_identity(*session);
  return outcome;
}

}  // namespace fude
