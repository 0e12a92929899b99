#include "sim/brush/bench_brush.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <vector>

#include "signal/elementary.h"
#include "sim/brush/footprint.h"
#include "sim/brush/loading.h"
#include "sim/brush/tuft_step.h"

namespace fude {
namespace {

constexpr int frames = 2000;
constexpr double frame_s = 1.0 / 250;

double ease(double t) {
  const double u = std::clamp(t, 0.0, 1.0);
  return u * u * (3 - 2 * u);
}

Eigen::Quaterniond about(const Eigen::Vector3d& axis, double angle) {
  const auto [sine, cosine] = elementary::sine_cosine(0.5 * angle);
  Eigen::Quaterniond q;
  q.w() = cosine;
  q.vec() = sine * axis;
  return q;
}

double at_share(const std::vector<double>& sorted, double share) {
  return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1) + 0.5)];
}

BrushBench::Times times_of(std::vector<double> us) {
  if (us.empty()) return {};
  std::sort(us.begin(), us.end());
  return {at_share(us, 0.5), at_share(us, 0.99), us.back()};
}

template <class Work>
double microseconds(Work work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

// In from the air, pressed, drawn along with changing pressure, turned, lifted off and away.
Pose<Paper, Handle> bench_pose(const BrushSpec& spec, double t) {
  const double scale = spec.tuft_length_mm / 32;
  const double wave = elementary::sine(3 * t) * ease(t - 1) * (1 - ease(2 * t - 10));
  const double drag = ease((t - 1) / 2.5);
  const double turn = ease((t - 3.5) / 2.5);
  Pose<Paper, Handle> pose;
  pose.translation = scale * Eigen::Vector3d(60 * drag + 20 * elementary::sine(3 * turn), -40 * turn,
                                             36 - 18 * ease(t / 1.2) + 4 * wave + 20 * ease((t - 6) / 1.2));
  pose.rotation = about(Eigen::Vector3d::UnitY(), 0.15 * elementary::cosine(t)) *
                  about(Eigen::Vector3d::UnitX(), 0.25) * about(Eigen::Vector3d::UnitZ(), turn);
  return pose;
}

BrushBench bench_brush(const BrushSpec& spec, int runs) {
  const Tuft tuft = make_tuft(spec);
  const HairTexture texture(spec, 1);
  Loading loading = dry_loading(tuft);
  fill(loading, 1, {1, 0, 0, 0.1F});
  const std::vector<InkLoad> loads = offered(loading);
  std::vector<double> solve_us(frames, std::numeric_limits<double>::infinity());
  std::vector<double> footprint_us(frames, std::numeric_limits<double>::infinity());
  std::vector<double> iterations;
  BrushBench bench;
  bench.frames = frames;
  for (int run = 0; run < runs; ++run) {
    TuftState state = rest_state(tuft);
    FootprintSweep sweep;
    for (int f = 0; f < frames; ++f) {
      const auto i = static_cast<std::size_t>(f);
      SolveReport report;
      const Pose<Paper, Handle> pose = bench_pose(spec, f * frame_s);
      const double solve = microseconds([&] { report = advance(tuft, state, pose, frame_s, f == 0); });
      const std::array<TimedSurface, 1> now = {
          {{swollen(surface_of(tuft, state.x, state.paper_from_handle), spec.soak_mm), frame_s}}};
      bool touched = false;
      const double footprint =
          microseconds([&] { touched = sweep.sweep(now, tuft.spec.cell_mm, texture, loads).has_value(); });
      solve_us[i] = std::min(solve_us[i], solve);
      if (touched) footprint_us[i] = std::min(footprint_us[i], footprint);
      if (run > 0) continue;
      iterations.push_back(report.iterations);
      bench.iterations_max = std::max(bench.iterations_max, report.iterations);
      if (!report.converged) ++bench.unconverged;
    }
  }
  std::erase_if(footprint_us, [](double us) { return std::isinf(us); });
  bench.us_per_frame = times_of(solve_us);
  bench.us_per_footprint = times_of(footprint_us);
  bench.iterations_median = times_of(iterations).median;
  return bench;
}

}  // namespace fude
