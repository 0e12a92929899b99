// Whether the stated intervals hold the truth as often as they say.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "calibration/delay/delay_estimate.h"
#include "calibration/delay/touch_fit.h"
#include "calibration/report.h"
#include "tests/fakes/scripted_strokes.h"

namespace fude {
namespace {

struct Honesty {
  int sessions = 0, found = 0, covered = 0;
  std::vector<double> errors_ms;
};

Honesty honesty_of(const ScriptedStrokes& script, int sessions) {
  Honesty honesty{.sessions = sessions};
  for (int i = 1; i <= sessions; ++i) {
    auto seen = script.seen(std::uint32_t(i));
    Witness tablet{.name = "tablet", .touches = seen.touches, .lifts = true};
    Witness tracker{.name = "tracker", .path = std::move(seen.path)};
    const auto delay = delay_between(tablet, tracker, {});
    if (!delay) continue;
    ++honesty.found;
    const double error = delay->line.offset_s - script.offset_s;
    honesty.errors_ms.push_back(std::abs(1e3 * error));
    honesty.covered += std::abs(error) < delay->offset_ci95_s;
  }
  return honesty;
}

void print(const char* name, const Honesty& h) {
  std::printf(
      "figure: delay, %s, %d sessions: rms %.3f ms, 95 in 100 within %.3f ms, worst %.3f ms, %d covered\n",
      name, h.sessions, root_mean_square(h.errors_ms), quantile(h.errors_ms, 0.95), quantile(h.errors_ms, 1),
      h.covered);
}

// Half a millimetre of threshold, touched at 20 to 500 mm/s; the fit alone, from where a search put it.
TEST(DelayHonesty, AThousandSessions) {
  const ScriptedStrokes script{.strokes = 40};
  Honesty h{.sessions = 1000};
  for (int i = 1; i <= h.sessions; ++i) {
    auto seen = script.seen(std::uint32_t(i));
    for (Eigen::Vector3d& point : seen.path.values) point = script.tilt().conjugate() * point;
    const auto fit = fit_touches(seen.touches, seen.path, {script.offset_s + 0.004}, {});
    ASSERT_TRUE(fit);
    const double error = fit->line.offset_s - script.offset_s;
    h.errors_ms.push_back(std::abs(1e3 * error));
    h.covered += std::abs(error) < student_975(fit->freedom) * fit->offset_sd_s;
  }
  print("40 strokes, 500 Hz tablet, 200 Hz tracker with 0.1 mm", h);
  EXPECT_LT(root_mean_square(h.errors_ms), 0.25);
  EXPECT_LT(quantile(h.errors_ms, 0.95), 0.5);
  EXPECT_GE(h.covered, 930);
  EXPECT_LE(h.covered, 970);
}

TEST(DelayHonesty, TheWholeWay) {
  const Honesty h = honesty_of({.strokes = 40, .offset_s = -0.2976}, 100);
  print("the whole way, -297.6 ms", h);
  EXPECT_EQ(h.found, h.sessions);
  EXPECT_LT(quantile(h.errors_ms, 0.95), 0.5);
  EXPECT_GE(h.covered, 88);
}

TEST(DelayHonesty, AHardPenAndACoarserTablet) {
  const Honesty hard = honesty_of({.hard = true}, 50);
  print("50 strokes of a hard pen", hard);
  EXPECT_GE(hard.found, 49);
  EXPECT_GE(hard.covered, 42);
  EXPECT_LT(root_mean_square(hard.errors_ms), 0.5);
  const Honesty coarse = honesty_of({.fastest_s = 0.15, .tablet_hz = 133, .tracker_hz = 100}, 50);
  print("50 strokes, 133 Hz tablet, 100 Hz tracker", coarse);
  EXPECT_GE(coarse.found, 49);
  EXPECT_GE(coarse.covered, 43);
}

}  // namespace
}  // namespace fude
