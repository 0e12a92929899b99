// A stroke for tests: pressed down, drawn along a curve, lifted; a function of time alone, so that it
// can be sampled at any rate.
#pragma once

#include <numbers>
#include <vector>

#include "calibration/tablet_surface.h"
#include "capture/session.h"
#include "rig/calibration/calibration_file.h"
#include "rig/replay.h"
#include "rig/share_folder.h"
#include "signal/elementary.h"

namespace fude::gesture {

inline constexpr double mm_per_count = 0.005;
inline constexpr double sheet_mm = 40;

inline DeviceDescription tablet() {
  DeviceDescription d;
  d.name = "test tablet";
  d.kind = DeviceKind::pen_tablet;
  d.axes = {{0, 0, 8000, 0, 0, 200, 0}, {1, 0, 8000, 0, 0, 200, 0}};
  d.width = d.height = Millimetres(sheet_mm);
  return d;
}

// The pen at `t_s` of a stroke of `length_s` seconds that begins at (x, y) mm from the upper left.
inline PenSample pen_at(double t_s, double length_s, double x_mm, double y_mm) {
  const double share = t_s / length_s;
  PenSample p;
  p.tool = PenTool::pen;
  p.in_proximity = true;
  p.in_contact = share >= 0 && share < 1;
  p.time.host = Timestamp(Duration(static_cast<std::int64_t>(t_s * 1e9 + 0.5)));
  p.x_counts = (x_mm + 18 * share) / mm_per_count;
  p.y_counts = (y_mm + 4 * elementary::sine(std::numbers::pi * share)) / mm_per_count;
  const double press = elementary::sine(std::numbers::pi * share);
  p.pressure = Fraction(p.in_contact ? 0.7 * press * press : 0);
  p.tilt_x = Radians(0.2);
  return p;
}

// `strokes` of them, below one another, at `rate_hz`.
inline Session session(double rate_hz, int strokes) {
  constexpr double length_s = 0.6;
  constexpr double pause_s = 0.2;
  Session s;
  s.devices.push_back({1, tablet()});
  InputOrder order = 1;
  for (int k = 0; k < strokes; ++k) {
    const double start_s = k * (length_s + pause_s);
    const int count = static_cast<int>((length_s + pause_s / 2) * rate_hz);
    for (int i = 0; i <= count; ++i) {
      const double t_s = i / rate_hz;
      RecordedPen pen{order++, 1, pen_at(t_s, length_s, 10, 8 + 8 * k), std::nullopt};
      pen.sample.time.host += Duration(static_cast<std::int64_t>(start_s * 1e9));
      pen.sample.time.sequence = static_cast<std::uint64_t>(order);
      s.pens.push_back(pen);
    }
  }
  return s;
}

// The same by a tablet that was calibrated: bent, turned and shifted with the pen's lean, on the same sheet.
inline Session calibrated(Session session) {
  session.devices[0].description.id = "056a:0001:T1";
  TabletSurface surface;
  surface.mm_from_counts << 0.0049, 1e-4, -1, -1e-4, -0.0049, 40, 0, 1e-6, 1;
  surface.lean_counts = {-600, -400};
  surface.width_mm = surface.height_mm = sheet_mm;
  surface.warp = SmoothField(FreeShape::plane, Eigen::RowVector2d(20, 20), 20,
                             Eigen::Matrix<double, 3, 2>{{-1, -1}, {1, 0}, {0.2, 0.9}},
                             Eigen::Matrix<double, 3, 2>{{0.5, 0.1}, {-0.7, 0.3}, {0.2, -0.4}},
                             Eigen::Matrix<double, 3, 2>{{0.2, -0.1}, {0.3, 0}, {0, 0.4}});
  CalibrationReport report{.procedure = "surface", .accepted = true, .devices = {"056a:0001:T1"}};
  session.calibrations.push_back({"surface", toml_of({to_fields(surface), report})});
  return session;
}

// What it is painted with: a round goat brush on cells of 0.2 mm.
inline ReplaySettings settings(int threads = 1) {
  ReplaySettings s;
  s.painting.brush = read_brush_spec(find_shared("brushes", "round-goat", ".toml")->string()).value();
  s.painting.ink.cell_mm = 0.2;
  s.painting.ink.threads = threads;
  s.reach = reach_of(s.painting.brush);
  s.palette.pigments = {pigments()[0]};
  return s;
}

}  // namespace fude::gesture
