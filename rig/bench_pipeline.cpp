#include "rig/bench_pipeline.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

#include "rig/live_painting.h"
#include "signal/elementary.h"

namespace fude {
namespace {

constexpr int cells_a_side = 512;
constexpr std::chrono::milliseconds between_reports{5};
constexpr int reports_a_picture = 3;
constexpr double in_the_air_s = 0.1;

// Water over the whole sheet, more than it evaporates in the time of the bench.
InkEvent flood(double side_mm) {
  constexpr int pours = 4;
  Deposit deposit;
  deposit.map = {0, 0, side_mm / cells_a_side, cells_a_side, cells_a_side, {}, {}, {}};
  const std::size_t cells = std::size_t{cells_a_side} * cells_a_side;
  deposit.map.fresh.assign(cells, 1.0F);
  deposit.map.contact_s.assign(cells, static_cast<float>(pours));
  deposit.map.patch.assign(cells, 0);
  deposit.patches = {{1, {0.1F, 0, 0, 0}}};
  return {.at = {}, .id = 0, .what = std::move(deposit)};
}

// A stroke a second, each with its snapshot.
PenSample circling(double t_s, double side_mm, double mm_per_count) {
  const elementary::SineCosine turn = elementary::sine_cosine(4 * t_s);
  PenSample pen;
  pen.tool = PenTool::pen;
  pen.in_proximity = true;
  pen.in_contact = t_s - std::floor(t_s) >= in_the_air_s;
  pen.pressure = Fraction(pen.in_contact ? 0.5 : 0);
  pen.x_counts = 0.5 * side_mm * (1 + 0.6 * turn.cosine) / mm_per_count;
  pen.y_counts = 0.5 * side_mm * (1 + 0.6 * turn.sine) / mm_per_count;
  return pen;
}

}  // namespace

Result<PipelineBench> bench_pipeline(const PaintingSetup& wanted, double seconds) {
  PaintingSetup setup = wanted;
  const double side_mm = cells_a_side * setup.ink.cell_mm;
  setup.ink.width_mm = setup.ink.height_mm = side_mm;
  auto painting = Painting::open(setup);
  if (!painting) return tl::unexpected(painting.error());
  painting->pour(flood(side_mm));
  painting->advance_to(10);

  TabletMapping mapping;
  mapping.mm_per_count_x = mapping.mm_per_count_y = 0.005;
  mapping.centre_x_counts = mapping.centre_y_counts = 0.5 * side_mm / mapping.mm_per_count_x;
  mapping.centre_x_mm = mapping.centre_y_mm = 0.5 * side_mm;

  using Clock = std::chrono::steady_clock;
  LivePainting live(std::move(*painting), reach_of(setup.brush), nullptr);
  const auto reports = static_cast<int>(seconds / std::chrono::duration<double>(between_reports).count());
  auto due = Clock::now();
  for (int i = 0; i < reports; ++i) {
    due += between_reports;
    std::this_thread::sleep_until(due);
    PenSample pen =
        circling(i * std::chrono::duration<double>(between_reports).count(), side_mm, mapping.mm_per_count_x);
    pen.time.host = Timestamp(std::chrono::duration_cast<Duration>(Clock::now().time_since_epoch()));
    pen.time.stamped_by = StampedBy::arrival;
    live.pen({1, pen, mapping});
    if (i % reports_a_picture == 0) (void)live.take_changes();  // as a window does
  }
  const Painting& done = live.stop().painting();
  std::vector<double> microseconds;
  for (const double ms : live.latencies_ms()) microseconds.push_back(1e3 * ms);
  return PipelineBench{quantiles(std::move(microseconds)), reports, done.step(),
                       static_cast<std::int64_t>(done.ink().active_cells())};
}

}  // namespace fude
