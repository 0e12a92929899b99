// A brush that touches a tilted sheet again and again, with known times: seen by a tracker, whose clock is
// ahead and may drift, and felt by a tablet once it is nearer than a threshold.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "calibration/delay/series.h"
#include "calibration/delay/touch.h"
#include "signal/pen_sample.h"
#include "tests/fakes/scripted_tracker.h"

namespace fude {

struct ScriptedStrokes {
  int strokes = 50;
  double offset_s = 0.0137;                  // added to the tracker's times to bring them to the tablet's
  double drift = 0;                          // and this much more each second
  double threshold_mm = 0.5;                 // above the paper, where the tablet feels the brush
  double lift_lower_mm = 0.3;                // a pressed tuft lifts that much lower
  double slowest_s = 0.5, fastest_s = 0.08;  // to come down, and to lift
  double period_s = 0;                       // 0: strokes come as they come; else one each period, all alike
  double tablet_hz = 500, tracker_hz = 200;
  double noise_mm = 0.1;
  bool hard = false;     // the tip stops dead on the paper
  bool one_way = false;  // every stroke from one height to one depth

  struct Stroke {
    double begin_s, down_s, still_s, up_s, high_mm, deep_mm, next_high_mm;
    Eigen::Vector2d from_mm, to_mm;
    double end_s() const { return begin_s + down_s + still_s + up_s; }
  };
  struct Seen {
    std::vector<Stroke> strokes;
    std::vector<Touch> touches;  // in the tablet's time
    Series path;                 // in the tracker's time and frame, metres
    double end_s = 0;
  };

  // The sheet's frame in the tracker's.
  Eigen::Quaterniond tilt() const {
    return Eigen::Quaterniond(Eigen::AngleAxisd(0.5, Eigen::Vector3d(1, -0.4, 0.2).normalized()));
  }

  // Height over the paper at a moment of the stroke, mm.
  double height_mm(const Stroke& s, double t) const {
    const auto eased = [](double u) {
      return 0.5 - 0.5 * std::cos(std::numbers::pi * std::clamp(u, 0.0, 1.0));
    };
    const double u = t - s.begin_s;
    double z = s.high_mm;
    if (u < s.down_s + s.still_s / 2)
      z = s.high_mm - (s.high_mm + s.deep_mm) * eased(u / s.down_s);
    else
      z = -s.deep_mm + (s.next_high_mm + s.deep_mm) * eased((u - s.down_s - s.still_s) / s.up_s);
    return hard ? std::max(z, 0.0) : z;
  }

  Seen seen(std::uint32_t seed) const {
    Noise random(seed);
    Seen result;
    double t = 1, high = random.uniform(8, 25);
    for (int i = 0; i < strokes; ++i) {
      Stroke s{t,
               fastest_s * std::pow(slowest_s / fastest_s, random.uniform(0, 1)),
               random.uniform(0.2, 0.6),
               fastest_s * std::pow(slowest_s / fastest_s, random.uniform(0, 1)),
               high,
               random.uniform(1, 4),
               random.uniform(8, 25),
               {random.uniform(-80, 80), random.uniform(-60, 60)},
               {random.uniform(-80, 80), random.uniform(-60, 60)}};
      if (period_s > 0) s = {t, 0.2, 0.3, 0.2, 15, 2, 15, s.from_mm, s.to_mm};
      if (one_way) s.high_mm = s.next_high_mm = 15, s.deep_mm = 2;
      high = s.next_high_mm;
      t = period_s > 0 ? t + period_s : s.end_s() + random.uniform(0.1, 0.5);
      result.strokes.push_back(s);
    }
    result.end_s = t + 1;
    const double scan = 1 / tablet_hz, phase = random.uniform(0, scan);
    for (const Stroke& s : result.strokes) {
      const auto crossing = [&](double above_s, double below_s, double level) {
        for (int k = 0; k < 40; ++k) {
          const double middle = (above_s + below_s) / 2;
          (height_mm(s, middle) > level ? above_s : below_s) = middle;
        }
        return (above_s + below_s) / 2;
      };
      const double down = crossing(s.begin_s, s.begin_s + s.down_s, threshold_mm);
      const double up = crossing(s.end_s(), s.end_s() - s.up_s, threshold_mm - (hard ? 0 : lift_lower_mm));
      for (const auto& [at, is_down] : {std::pair{down, true}, std::pair{up, false}})
        result.touches.push_back({phase + scan * std::ceil((at - phase) / scan), scan, is_down});
    }
    std::size_t now = 0;
    for (double at = random.uniform(0, 1 / tracker_hz); at < result.end_s; at += 1 / tracker_hz) {
      const double true_s = at + offset_s + drift * at;
      while (now + 1 < result.strokes.size() && result.strokes[now + 1].begin_s < true_s) ++now;
      const Stroke& s = result.strokes[now];
      const double share = std::clamp((true_s - s.begin_s) / (s.end_s() - s.begin_s), 0.0, 1.0);
      const Eigen::Vector2d xy = s.from_mm + share * (s.to_mm - s.from_mm);
      const Eigen::Vector3d on_sheet(xy.x(), xy.y(), height_mm(s, true_s));
      result.path.add(at,
                      1e-3 * (tilt() * on_sheet + random.vector(noise_mm)) + Eigen::Vector3d(0.1, 0.2, -1));
    }
    return result;
  }

  // The same as a tablet and a tracker say it; the tool is the tip.
  std::vector<PenSample> pens(const Seen& seen) const {
    std::vector<PenSample> samples;
    const double scan = 1 / tablet_hz;
    std::size_t next = 0;
    PenSample pen;
    pen.tool = PenTool::brush;
    pen.in_proximity = true;
    double t = seen.touches.front().t_s;
    t -= scan * std::floor(t / scan);
    for (; t < seen.end_s; t += scan) {
      while (next < seen.touches.size() && seen.touches[next].t_s < t + scan / 2)
        pen.in_contact = seen.touches[next++].down;
      pen.time.host = pose_sample({}, t).time.host;
      pen.x_counts = std::round(1000 * std::sin(t));
      pen.y_counts = std::round(1000 * std::cos(0.7 * t));
      samples.push_back(pen);
    }
    return samples;
  }
  std::vector<PoseSample> poses(const Seen& seen) const {
    std::vector<PoseSample> samples;
    for (std::size_t i = 0; i < seen.path.size(); ++i) {
      samples.push_back(pose_sample({}, seen.path.t_s[i]));
      samples.back().tracker_from_tool.translation = seen.path.values[i];
    }
    return samples;
  }
};

}  // namespace fude
