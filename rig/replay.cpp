#include "rig/replay.h"

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <new>
#include <span>

#include "rig/history.h"
#include "rig/inputs.h"
#include "rig/session_summary.h"

namespace fude {
namespace {

using WallClock = std::chrono::steady_clock;  // for the report only: nothing simulated depends on it

constexpr double longest_settling_s = 3600;
constexpr std::size_t snapshots_kept = 8;

double since(WallClock::time_point start) {
  return std::chrono::duration<double>(WallClock::now() - start).count();
}

double peak_megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1024 / 1e6;
}

void count_samples(const Session& session, ReplayReport& report) {
  std::map<DeviceNumber, bool> touching;
  for (const RecordedPen& pen : session.pens) {
    report.samples += counts_as_sample(pen.sample);
    report.lost_samples += pen.sample.after_gap;
    bool& touches = touching[pen.device];
    const bool now = pen.sample.in_proximity && pen.sample.in_contact;
    report.strokes += now && !touches;
    touches = now;
  }
  for (const Receipt& receipt : session.receipts) report.lost_samples += receipt.dropped;
  const SessionSpan span = span_of(session);
  report.session_s = seconds(span.last - span.first);
}

bool undoes(const Session& session) {
  return std::any_of(session.actions.begin(), session.actions.end(), [](const RecordedAction& a) {
    return std::holds_alternative<Undo>(a.action.what) || std::holds_alternative<Redo>(a.action.what);
  });
}

struct Observed {
  std::vector<double> step_ms;
  std::vector<double> solve_us;
  std::vector<SolvedForce> forces;
};

}  // namespace

Quantiles quantiles(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
  };
  return {at(0.5), at(0.99)};
}

PenReach reach_of(const BrushSpec& brush) { return {.tuft_length = Millimetres(brush.tuft_length_mm)}; }

Picture picture_of(const Ink& ink, const Palette& palette) {
  const int columns = ink.columns();
  const int rows = ink.rows();
  Picture picture(columns, rows);
  // Strips of a tile's height: less would bring a graphics card's tiles here many times over.
  constexpr int strip = 32;
  for (int bottom = 0; bottom < rows; bottom += strip) {
    const InkRegion cells = ink.read({0, bottom, columns, strip});
    const auto width = static_cast<std::size_t>(columns);
    for (int y = 0; y < cells.rect.rows; ++y)
      colour_row(std::span(cells.pigment).subspan(static_cast<std::size_t>(y) * width, width), palette,
                 picture.row(rows - 1 - (bottom + y)));
  }
  return picture;
}

namespace {

// Paints the session's inputs on the sheet it began on.
Result<History> paint_again(const Session& session, const ReplaySettings& settings,
                            const std::function<void(double)>& progress, Observed& observed) {
  auto plan = plan_sheet(session, settings.wish);
  if (!plan) return tl::unexpected(plan.error());
  PaintingSetup setup = settings.painting;
  setup.ink.width_mm = plan->sheet.width.value;
  setup.ink.height_mm = plan->sheet.height.value;
  auto painting = Painting::open(setup);
  if (!painting) return tl::unexpected(painting.error());
  if (session.sheet) {
    const auto sheet = sheet_from_bytes(session.sheet->state);
    if (!sheet) return tl::unexpected(sheet.error());
    if (auto laid = lay_sheet(*sheet, painting->ink()); !laid) return tl::unexpected(laid.error());
  }
  History history(std::move(*painting), undoes(session) ? snapshots_kept : 0);

  auto told = WallClock::now();
  const double step_s = history.painting().step_s();
  const std::vector<TimedInput> inputs = inputs_of(session, *plan, settings.reach, step_s);
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    history.advance_to(inputs[i].step);
    history.apply(inputs[i].input);
    if (const auto* move = std::get_if<BrushMove>(&inputs[i].input)) {
      const SolveCounts& solves = history.painting().solves();
      observed.solve_us.push_back(solves.last_us);
      observed.forces.push_back({move->input.time.host, move->end, solves.last_on_hand});
    }
    if (since(told) > 0.2) {
      told = WallClock::now();
      progress(static_cast<double>(i) / static_cast<double>(inputs.size()));
    }
  }
  const double settle_s = settings.settle.until_dry ? longest_settling_s : settings.settle.seconds;
  const Step end = history.step() + 1 + static_cast<Step>(std::ceil(settle_s / step_s));
  while (history.step() < end) {
    history.advance_to(history.step() + 1);
    if (settings.settle.until_dry && history.painting().ink().still()) break;
  }
  (void)history.painting().ink();
  observed.step_ms = history.painting().step_ms();
  progress(1);
  return history;
}

Error too_little_memory() {
  return {Fault::storage, "not enough memory for this sheet; give a smaller --size-mm or a larger --cell-mm"};
}

}  // namespace

Result<Replayed> replay(const Session& session, const ReplaySettings& settings,
                        const std::function<void(double)>& progress) try {
  const auto start = WallClock::now();
  Observed observed;
  auto history = paint_again(session, settings, progress, observed);
  if (!history) return tl::unexpected(history.error());
  const Ink& ink = history->painting().ink();
  const InkSetup& setup = settings.painting.ink;
  Replayed result;
  ReplayReport& report = result.report;
  report.wall_s = since(start);
  report.dt_s = history->painting().step_s();
  report.steps = history->step();
  count_samples(session, report);
  report.step_ms = quantiles(std::move(observed.step_ms));
  report.us_per_solve = quantiles(std::move(observed.solve_us));
  report.solves = history->painting().solves();
  report.ink = ink.totals();
  report.backend = setup.backend == InkBackend::gl ? "gl" : "cpu";
  report.isa = setup.backend == InkBackend::gl ? "" : name_of(*choose_instruction_set(setup.instruction_set));
  report.threads = setup.threads;
  for (const Pigment& pigment : settings.palette.pigments) report.pigments.emplace_back(pigment.name);
  result.forces = std::move(observed.forces);
  result.picture = picture_of(ink, settings.palette);
  report.picture_sha256 = picture_sha256(result.picture);
  report.peak_mb = peak_megabytes();
  return result;
} catch (const std::bad_alloc&) {
  return tl::unexpected(too_little_memory());
}

Result<SheetSnapshot> painted_sheet(const Session& session, const ReplaySettings& settings,
                                    const std::function<void(double)>& progress) try {
  Observed observed;
  const auto history = paint_again(session, settings, progress, observed);
  if (!history) return tl::unexpected(history.error());
  return sheet_of(history->painting().ink());
} catch (const std::bad_alloc&) {
  return tl::unexpected(too_little_memory());
}

}  // namespace fude
