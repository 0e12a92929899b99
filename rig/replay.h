// A session painted again: every input at the step where it was applied, or where its time puts it.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "capture/session.h"
#include "rig/painting.h"
#include "rig/sheet_plan.h"
#include "rig/sheet_snapshot.h"
#include "signal/result.h"
#include "sim/optics/colour.h"
#include "sim/optics/picture.h"

namespace fude {

struct Quantiles {
  double median = 0;
  double p99 = 0;
};

// The median and the 99th percentile; zeros of nothing.
Quantiles quantiles(std::vector<double> values);

// Figures of one replay; the fields of `--report`.
struct ReplayReport {
  std::int64_t samples = 0;
  std::int64_t lost_samples = 0;
  std::int64_t strokes = 0;
  double session_s = 0;
  double wall_s = 0;
  std::int64_t steps = 0;
  double dt_s = 0;
  Quantiles step_ms;
  std::string backend;
  std::string isa;
  int threads = 0;
  double peak_mb = 0;
  std::vector<std::string> pigments;
  std::string picture_sha256;
  InkTotals ink;
  SolveCounts solves;
  Quantiles us_per_solve;
};

// Simulated seconds to run on after the last input, or until the sheet is dry.
struct Settle {
  double seconds = 0;
  bool until_dry = false;
};

struct ReplaySettings {
  PaintingSetup painting;  // the sheet's size is set from the plan
  PenReach reach;
  SheetWish wish;
  Settle settle;
  Palette palette;
  std::map<std::string, std::string> to_record;  // what a session painted with these says of them
};

// What the solved brush did to the hand at one painted sample, where no device measured it.
struct SolvedForce {
  Timestamp time;  // of the sample, by the host
  PenEnd end{};
  Wrench on_hand;
};

struct Replayed {
  Picture picture;
  ReplayReport report;
  std::vector<SolvedForce> forces;  // one a painted sample, in the order of painting
};

// `progress` is told the share done, 0 to 1, a few times a second at most.
// Errors: those of the plan and of the ink's back-end; storage where memory does not suffice.
Result<Replayed> replay(const Session& session, const ReplaySettings& settings,
                        const std::function<void(double)>& progress);

// The sheet as a session leaves it, to paint on. Errors: those of replay().
Result<SheetSnapshot> painted_sheet(const Session& session, const ReplaySettings& settings,
                                    const std::function<void(double)>& progress);

// The whole sheet as a picture: one pixel a cell.
Picture picture_of(const Ink& ink, const Palette& palette);

// How deep a pen may press the brush: the part of the mapping that the brush decides.
PenReach reach_of(const BrushSpec& brush);

}  // namespace fude
