// What one stream shows of the brush: where it goes, how it turns, when it touches.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "calibration/delay/series.h"
#include "calibration/delay/touch.h"
#include "calibration/surface.h"
#include "signal/sample.h"

namespace fude {

struct Witness {
  std::string name;
  Series path;                 // of the tip, m; of a tablet its x and y in counts; empty: it shows none
  bool levelled = false;       // path is on the paper: x, y and height over it
  bool flat = false;           // path has no height
  Series turn_rate;            // about the body's own axes, rad/s
  std::vector<Touch> touches;  // of a tablet; of an inertial unit the jolts that may be touches
  bool lifts = false;          // touches has lifts as well

  // What happened to it.
  std::size_t seen = 0, unusable = 0, backwards = 0;
  std::optional<double> restarted_s;  // its times went back by more than a tenth of a second here
  bool frozen = false;                // all of its samples say the same

  bool shows_nothing() const { return path.empty() && turn_rate.empty() && touches.empty(); }
  double begin_s() const;
  double end_s() const;
};

class WitnessReader {
 public:
  explicit WitnessReader(std::string name) { witness_.name = std::move(name); }

  // Where the tip is in the tool's frame, else its origin goes for it; and the sheet, where it is known.
  void know(std::optional<Eigen::Vector3d> tip_m, std::optional<SurfaceCalibration> surface) {
    tip_m_ = tip_m;
    surface_ = std::move(surface);
  }

  // Seconds of the sample's host time. Poses, positions, force-feedback arms, pens, fingers and inertial
  // units; others show nothing.
  void add(const Sample& sample);

  // Touches of a pen follow from contact: chatter of less than 30 ms is none. Jolts: where the specific force
  // changes between two readings by more than eight times what is usual, and most within a tenth of a second.
  Witness witness() const;

  // Samples before that are as if they had never been.
  void forget_before(double t_s);
  void begin_anew();
  bool restarted() const { return witness_.restarted_s.has_value(); }
  std::optional<double> last_s() const { return last_s_; }

  std::size_t samples() const { return witness_.seen - witness_.unusable; }
  std::size_t touches() const { return witness_.touches.size(); }
  double span_s() const { return witness_.end_s() - witness_.begin_s(); }

 private:
  struct Reading;
  void see(const PoseSample& sample, double t_s);
  void see(const ImuSample& sample, double t_s);
  void see_point(const Eigen::Vector3d& point_m, double t_s);
  void see_contact(bool contact, bool after_gap, double t_s);
  bool comes_later(double t_s);

  Witness witness_;
  std::optional<Eigen::Vector3d> tip_m_;
  std::optional<SurfaceCalibration> surface_;
  Series force_;
  Series contact_;  // 1 while touching, in x; for the intervals alone
  std::optional<double> last_s_;
  std::optional<bool> touching_;
  std::optional<std::pair<double, Eigen::Quaterniond>> last_turn_;
};

}  // namespace fude
