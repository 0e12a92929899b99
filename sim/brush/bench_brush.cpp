#include "sim/brush/bench_brush.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <limits>
#include <vector>

#include "sim/brush/brush.h"
#include "sim/brush/tuft_step.h"

namespace fude {
namespace {

constexpr int frames = 2000;
constexpr double frame_s = 1.0 / 250;
constexpr double row_step_mm = 2;  // between the roots of several tufts
constexpr double tracker_hz = 1000;

double at_share(const std::vector<double>& sorted, double share) {
  return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1) + 0.5)];
}

template <class Work>
double microseconds(Work work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

BrushBench::Times times_of(std::vector<double> us) {
  if (us.empty()) return {};
  std::sort(us.begin(), us.end());
  return {at_share(us, 0.5), at_share(us, 0.99), us.back()};
}

BrushBench bench_brush(const BrushSpec& spec, const BenchGesture& gesture, int tufts, int runs) {
  std::vector<TuftRoot> roots = arrangement(spec, 1);
  if (roots.size() == 1) {
    roots.resize(static_cast<std::size_t>(tufts));
    for (std::size_t t = 0; t < roots.size(); ++t)
      roots[t].at.x() = row_step_mm * static_cast<double>(t) / spec.root_radius_mm;
  }
  const Tuft tuft = make_tuft(hair_of(spec, roots.front()));  // all alike
  std::vector<double> solve_us(frames, std::numeric_limits<double>::infinity());
  std::vector<double> iterations;
  BrushBench bench;
  bench.frames = frames;
  for (int run = 0; run < runs; ++run) {
    std::vector<TuftState> states(roots.size(), rest_state(tuft));
    for (int f = 0; f < frames; ++f) {
      const Pose<Paper, Handle> pose = gesture.pose(spec, f * frame_s);
      std::vector<SolveReport> reports(states.size());
      const double us = microseconds([&] {
        for (std::size_t t = 0; t < states.size(); ++t)
          reports[t] = advance(tuft, states[t], root_pose(spec, roots[t], pose), frame_s, f == 0);
      });
      solve_us[static_cast<std::size_t>(f)] = std::min(solve_us[static_cast<std::size_t>(f)], us);
      if (run > 0) continue;
      for (const SolveReport& report : reports) {
        iterations.push_back(report.iterations);
        bench.iterations_max = std::max(bench.iterations_max, report.iterations);
        bench.unconverged += report.converged ? 0 : 1;
        bench.max_violation = std::max(bench.max_violation, report.violation_mm / spec.tuft_length_mm);
      }
    }
  }
  bench.us_per_frame = times_of(solve_us);
  bench.iterations_median = times_of(iterations).median;
  return bench;
}

MoveBench bench_move(const BrushSpec& spec, const BenchGesture& gesture, int runs) {
  constexpr int moves = static_cast<int>(bench_gesture_s * tracker_hz);
  std::vector<double> us(moves, std::numeric_limits<double>::infinity());
  MoveBench bench;
  bench.frames = moves;
  for (int run = 0; run < runs; ++run) {
    Brush brush(spec, 1);
    brush.load(1, {1, 0, 0, 0.1F});
    brush.set_endless(true);
    for (int f = 0; f < moves; ++f) {
      BrushInput input;
      input.time.host = Timestamp(Duration(static_cast<std::int64_t>(f * (1e9 / tracker_hz))));
      input.origin = PoseOrigin::measured;
      input.paper_from_handle = gesture.pose(spec, f / tracker_hz);
      BrushFrame frame;
      auto& least = us[static_cast<std::size_t>(f)];
      least = std::min(least, microseconds([&] { frame = brush.move(input); }));
      if (run > 0) continue;
      bench.marks += frame.deposit ? 1 : 0;
      bench.unconverged += frame.solve.converged ? 0 : 1;
    }
  }
  bench.us_per_frame = times_of(us);
  return bench;
}

}  // namespace fude
