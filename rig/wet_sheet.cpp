#include "rig/wet_sheet.h"

#include <chrono>
#include <cmath>
#include <thread>
#include <utility>

#include "signal/elementary.h"

namespace fude {
namespace {

constexpr int cells_a_side = 512;
constexpr std::chrono::milliseconds between_reports{5};
constexpr int reports_a_picture = 3;
constexpr double in_the_air_s = 0.1;

// Water over the whole sheet, more than it evaporates in the time of a bench.
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

TabletMapping middle_on_middle(double side_mm) {
  TabletMapping mapping;
  mapping.mm_per_count_x = mapping.mm_per_count_y = 0.005;
  mapping.centre_x_counts = mapping.centre_y_counts = 0.5 * side_mm / mapping.mm_per_count_x;
  mapping.centre_x_mm = mapping.centre_y_mm = 0.5 * side_mm;
  return mapping;
}

}  // namespace

Result<std::unique_ptr<WetSheet>> WetSheet::open(const PaintingSetup& wanted) {
  PaintingSetup setup = wanted;
  const double side_mm = cells_a_side * setup.ink.cell_mm;
  setup.ink.width_mm = setup.ink.height_mm = side_mm;
  auto painting = Painting::open(setup);
  if (!painting) return tl::unexpected(painting.error());
  painting->pour(flood(side_mm));
  painting->advance_to(10);
  return std::unique_ptr<WetSheet>(new WetSheet(std::move(*painting), reach_of(setup.brush), side_mm));
}

WetSheet::WetSheet(Painting painting, const PenReach& reach, double side_mm)
    : side_mm_(side_mm), mapping_(middle_on_middle(side_mm)), live_(std::move(painting), reach, nullptr) {}

int WetSheet::draw(double seconds, const std::function<void()>& reported) {
  using Clock = std::chrono::steady_clock;
  constexpr double period_s = std::chrono::duration<double>(between_reports).count();
  const auto count = static_cast<int>(seconds / period_s);
  auto due = Clock::now();
  for (int i = 0; i < count; ++i, ++reports_) {
    due += between_reports;
    std::this_thread::sleep_until(due);
    PenSample pen = circling(reports_ * period_s, side_mm_, mapping_.mm_per_count_x);
    pen.time.host = Timestamp(std::chrono::duration_cast<Duration>(Clock::now().time_since_epoch()));
    pen.time.stamped_by = StampedBy::arrival;
    live_.pen({1, pen, mapping_});
    if (reports_ % reports_a_picture == 0) (void)live_.take_changes();  // as a window does
    if (reported) reported();
  }
  return count;
}

}  // namespace fude
