#include "rig/performance.h"

#include <linux/input.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "rig/import_session.h"
#include "rig/performed_path.h"

namespace fude {
namespace {

constexpr int counts_per_mm = 100;
constexpr int full_pressure = 8191;
constexpr double counts_per_radian = 57;
constexpr double hover_mm = 8;  // the whole range of the distance axis
constexpr int hover_counts = 63;
constexpr double air_height_mm = 6;

DeviceDescription pen_display(const Performance& p) {
  DeviceDescription d;
  d.name = "scripted pen: " + p.name;
  d.transport = "evdev";
  d.kind = DeviceKind::pen_tablet;
  d.bus = BUS_VIRTUAL;
  d.serial = p.name;
  d.id = device_id(d);
  d.keys = {BTN_TOOL_PEN, BTN_TOUCH};
  const auto counts = [](Millimetres mm) {
    return static_cast<std::int32_t>(std::lround(mm.value * counts_per_mm));
  };
  d.axes = {{ABS_X, 0, counts(p.width), 0, 0, counts_per_mm, 0},
            {ABS_Y, 0, counts(p.height), 0, 0, counts_per_mm, 0},
            {ABS_PRESSURE, 0, full_pressure, 0, 0, 0, 0},
            {ABS_DISTANCE, 0, hover_counts, 0, 0, 0, 0},
            {ABS_TILT_X, -64, 63, 0, 0, static_cast<std::int32_t>(counts_per_radian), 0},
            {ABS_TILT_Y, -64, 63, 0, 0, static_cast<std::int32_t>(counts_per_radian), 0}};
  return d;
}

// Sends what changed, one frame a report, as a tablet does.
class VirtualTablet {
 public:
  explicit VirtualTablet(const Performance& performance)
      : device_(pen_display(performance)), height_mm_(performance.height.value) {}

  void report(double t_s, const PerformedKnot& at, double height_mm, const PerformedStroke& stroke) {
    const bool touches = height_mm <= 0;
    set(EV_KEY, BTN_TOOL_PEN, 1);
    set(EV_ABS, ABS_X, rounded(at.x_mm * counts_per_mm));
    set(EV_ABS, ABS_Y, rounded((height_mm_ - at.y_mm) * counts_per_mm));
    set(EV_ABS, ABS_PRESSURE, touches ? std::max(1, rounded(at.pressure * full_pressure)) : 0);
    set(EV_ABS, ABS_DISTANCE, touches ? 0 : rounded(std::min(1.0, height_mm / hover_mm) * hover_counts));
    set(EV_ABS, ABS_TILT_X, rounded(stroke.tilt_x.value * counts_per_radian));
    set(EV_ABS, ABS_TILT_Y, rounded(stroke.tilt_y.value * counts_per_radian));
    set(EV_KEY, BTN_TOUCH, touches);
    send(t_s);
  }
  void leave(double t_s) {
    set(EV_KEY, BTN_TOOL_PEN, 0);
    send(t_s);
  }
  RawRecording finish() && {
    recording_.device = std::move(device_);
    return std::move(recording_);
  }

 private:
  static int rounded(double value) { return static_cast<int>(std::lround(value)); }

  void set(std::uint16_t type, std::uint16_t code, std::int32_t value) {
    const auto known = std::find_if(sent_.begin(), sent_.end(),
                                    [&](const EvdevEvent& e) { return e.type == type && e.code == code; });
    if (known == sent_.end())
      sent_.push_back({type, code, value});
    else if (known->value == value)
      return;
    else
      known->value = value;
    frame_.push_back({type, code, value});
  }
  void send(double t_s) {
    frame_.push_back({EV_SYN, SYN_REPORT, 0});
    recording_.counts.events += frame_.size();
    ++recording_.counts.frames;
    Transfer transfer;
    transfer.time = Timestamp(Duration(static_cast<std::int64_t>(std::llround(t_s * 1e9))));
    transfer.stamped_by = StampedBy::recording;
    transfer.payload = pack_events(frame_);
    recording_.transfers.push_back(std::move(transfer));
    frame_.clear();
  }

  DeviceDescription device_;
  double height_mm_;
  std::vector<EvdevEvent> sent_;
  std::vector<EvdevEvent> frame_;
  RawRecording recording_;
};

}  // namespace

Performed perform(const Performance& performance) {
  Performed performed;
  VirtualTablet tablet(performance);
  const double dt_s = 1 / performance.rate_hz;
  std::int64_t reports = 0;
  PerformedKnot at = performance.strokes.front().knots.front();
  for (const PerformedStroke& stroke : performance.strokes) {
    const Timestamp begin(Duration(static_cast<std::int64_t>(static_cast<double>(reports) * dt_s * 1e9)));
    for (const auto& what : stroke.prepare) performed.actions.push_back({begin, what});
    const PerformedKnot& start = stroke.knots.front();
    const auto in_air = static_cast<std::int64_t>(stroke.rest_s * performance.rate_hz);
    for (std::int64_t i = 0; i < in_air; ++i) {
      const double share = static_cast<double>(i) / static_cast<double>(in_air);
      const double way = least_jerk(share);
      const PerformedKnot above{
          at.x_mm + way * (start.x_mm - at.x_mm), at.y_mm + way * (start.y_mm - at.y_mm), 0, {}};
      tablet.report(static_cast<double>(reports++) * dt_s, above,
                    0.2 + air_height_mm * 4 * share * (1 - share), stroke);
    }
    const PerformedPath path(stroke.knots);
    const auto on_paper = static_cast<std::int64_t>(path.seconds() * performance.rate_hz);
    for (std::int64_t i = 0; i <= on_paper; ++i)
      tablet.report(static_cast<double>(reports++) * dt_s, path.at(static_cast<double>(i) * dt_s), 0, stroke);
    at = stroke.knots.back();
    tablet.report(static_cast<double>(reports++) * dt_s, at, 0.2, stroke);
  }
  tablet.leave(static_cast<double>(reports) * dt_s);
  performed.recording = std::move(tablet).finish();
  return performed;
}

Result<void> write_performance(const Performance& performance, const std::filesystem::path& session,
                               bool overwrite) {
  const Performed performed = perform(performance);
  std::map<std::string, std::string> settings;
  if (performance.palette) settings["palette"] = performance.palette->toml;
  if (performance.sheet) {
    std::ostringstream sides;
    sides << performance.sheet->width.value << 'x' << performance.sheet->height.value;
    settings["sheet_mm"] = sides.str();
  }
  return write_recordings({&performed.recording, 1}, performed.actions, "performance", session, overwrite,
                          settings)
      .map([](const std::vector<ImportedStream>&) {});
}

}  // namespace fude
