// The delay between two witnesses by each way there is, with what can be said against it.
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "calibration/delay/touch.h"
#include "calibration/delay/witness.h"
#include "calibration/report.h"

namespace fude {

// The offset about one moment of the session.
struct DelayMoment {
  double t_s = 0;  // of A
  double offset_s = 0;
  double ci95_s = 0;  // half of the interval; of this moment against the others
};

struct DelayEstimate {
  std::string method;        // in words: "touches of A on the way of B"
  DelayLine line;            // added to B's times to bring them to A's; drift 0 where it is not significant
  double offset_ci95_s = 0;  // half of the interval
  double drift = 0, drift_ci95 = 0;  // also where it is not significant; s/s
  std::vector<double> residuals_s;   // of what was used
  std::optional<double> held_out_rms_s;
  std::optional<double> halves_apart_s;
  std::vector<DelayMoment> course;
  std::vector<std::string> warnings;
  Fields details;
};

struct DelaySearch {
  double range_s = 2;  // offsets of −range to range
  bool drifts = true;  // look for a drift
};

using DelayFinding = tl::expected<DelayEstimate, std::string>;  // else the likely cause, in words

// `moving` goes to the surface where `touching` feels it.
DelayFinding delay_by_touches(const Witness& touching, const Witness& moving, const DelaySearch& search);
// Both feel touches.
DelayFinding delay_by_pairs(const Witness& a, const Witness& b, const DelaySearch& search);
// Both see one motion.
DelayFinding delay_by_motion(const Witness& a, const Witness& b, const DelaySearch& search);

// The way that suits what the two are: the motion that both see (turn rates, or ways) where there is one,
// else, also where they turn out not to see the same, touches on a way, else touches of both. A tablet and a
// tracker are brought together by touches.
DelayFinding delay_between(const Witness& a, const Witness& b, const DelaySearch& search);

// A drift counts from three standard deviations on (by chance in one of 400 sessions), and where it moves the
// offset by more than its interval, and a tenth of a millisecond, within half of the session.
bool significant(double drift, double drift_sd, double half_session_s, double offset_ci95_s);

// Where, in the order of time, those that agree are parted from those that do not: one device's clock has
// started anew there. None where they are mixed.
struct InTime {
  double t_s = 0;
  bool agrees = false;
};
std::optional<double> break_in_time(const std::vector<InTime>& all);

// "the clock of pen or tracker started anew at 12.3 s of the session: …"
std::string restart_in_words(const std::string& whose, const std::string& when);

}  // namespace fude
