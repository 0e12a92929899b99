// Offset, drift and the height at which a touch is felt, fitted together to all touches of a path.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "calibration/delay/series.h"
#include "calibration/delay/touch.h"

namespace fude {

struct TouchResidual {
  std::size_t touch = 0;  // its number
  double height_off = 0;  // of the path at the touch, over the height that the fit has there
  double rate = 0;        // of height, per second
  double weight = 0;      // 1 over the variance of height_off
  bool agrees = false;
};

struct TouchFit {
  DelayLine line;  // added to the path's times to bring them to the touches'; reference: their middle
  double offset_sd_s = 0;
  double drift_sd = 0;                    // 0 where no drift was fitted
  double freedom = 0;                     // touches less parameters
  double down_height = 0, up_height = 0;  // in the path's unit; up 0 where no lift was seen
  std::vector<TouchResidual> residuals;   // of touches that lie on the path
  double speed = 0;                       // weighted root mean square of the rates
  double speed_spread = 0;  // how far they differ among themselves, without noise; relative to speed
  bool stops = false;       // the path breaks off at the touch, as of a hard pen
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();   // of the surface
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();  // where it has those heights
  std::size_t used() const;
};

struct TouchModel {
  bool levelled = false;  // heights are true; otherwise the surface may slope by a little
  bool drifts = false;
};

// At a touch at t, the height at t − offset(t) is the same for all that come down and, on its own, for all
// that lift (a tuft that was pressed lifts later than it touched). Slow and fast touches tell that height
// from the offset. The likeliest, by Fisher's scoring: heights and rates of smoothing splines, with the
// noise that the path shows; any moment between two samples of the touching stream alike (felt_touch.h); and
// what the touches are more uneven than both, in height and in time. Touches off by more than four standard
// deviations are left out. The standard deviation is that of the likelihood, or of the touches' own scatter
// where that is wider. None: fewer than `fewest_touches` lie on the path and agree, or it runs away from
// `start` by a tenth of a second or a drift of 1000 ppm.
inline constexpr std::size_t fewest_touches = 10;
std::optional<TouchFit> fit_touches(std::span<const Touch> touches, const Series& path,
                                    const DelayLine& start, const TouchModel& model);

// The residual as time at the usual speed, s: for each touch that agrees.
std::vector<double> residual_times(const TouchFit& fit);
// Of touches that the fit did not see, for those that lie on the path; they agree within four times `most_s`.
std::vector<TouchResidual> residuals_against(const TouchFit& fit, std::span<const Touch> others,
                                             const Series& path, double most_s);

}  // namespace fude
