#include "rig/live_painting.h"

#include <algorithm>
#include <chrono>
#include <new>
#include <stdexcept>
#include <utility>

#include "rig/brush_view/brush_picture.h"
#include "rig/precedence.h"

namespace fude {
namespace {

using LiveClock = std::chrono::steady_clock;  // CLOCK_MONOTONIC: the clock of the kernel's stamps

constexpr std::size_t snapshots_kept = 8;
constexpr std::size_t latencies_kept = 1'000'000;
constexpr std::chrono::milliseconds between_pictures{16};
// Cells that are read at once for the window: longer reading would keep the brush waiting for an answer.
constexpr int cells_a_picture = 1 << 16;
// Where the ink is behind, how soon to look whether it has come up.
constexpr std::chrono::microseconds soon{500};
// A machine that is further behind than this lets simulated time wait instead of running after it.
constexpr double patience_s = 0.25;

bool empty(const CellRect& r) { return r.columns <= 0 || r.rows <= 0; }

CellRect united(const CellRect& a, const CellRect& b) {
  if (empty(a)) return b;
  if (empty(b)) return a;
  CellRect r{std::min(a.left, b.left), std::min(a.bottom, b.bottom), 0, 0};
  r.columns = std::max(a.left + a.columns, b.left + b.columns) - r.left;
  r.rows = std::max(a.bottom + a.rows, b.bottom + b.rows) - r.bottom;
  return r;
}

Timestamp now() {
  return Timestamp(std::chrono::duration_cast<Duration>(LiveClock::now().time_since_epoch()));
}

double milliseconds(Duration d) { return seconds(d) * 1e3; }

}  // namespace

LivePainting::LivePainting(Painting painting, const PenReach& reach, Recorder* recorder,
                           const PenManner& manner, Extent sheet)
    : history_(std::move(painting), snapshots_kept),
      reach_(reach),
      held_(manner, sheet),
      recorder_(recorder),
      thread_([this] { serve(); }) {
  std::unique_lock lock(mutex_);
  begun_.wait(lock, [this] { return started_ || failed_; });
}

LivePainting::~LivePainting() { stop(); }

void LivePainting::pen(LivePen pen) {
  {
    const std::lock_guard lock(mutex_);
    queue_.emplace_back(std::move(pen));
  }
  wake_.notify_one();
}

void LivePainting::act(Action action) {
  {
    const std::lock_guard lock(mutex_);
    queue_.emplace_back(std::move(action));
  }
  wake_.notify_one();
}

void LivePainting::apply(const LiveInput& input) {
  const Step step = history_.step();
  if (const auto* action = std::get_if<Action>(&input)) {
    history_.apply(*action);
    const std::lock_guard lock(mutex_);
    unshown_ = {0, 0, history_.painting().ink().columns(), history_.painting().ink().rows()};
    if (recorder_) recorder_->add(RecordedAction{0, *action, step});
    return;
  }
  const auto& pen = std::get<LivePen>(input);
  const PenSample held = held_.held(pen.device, pen.sample, pen.mapping);
  history_.apply(brush_move(held, pen.mapping, reach_));
  if (recorder_) recorder_->add(RecordedPen{0, pen.device, pen.sample, step});
  const std::lock_guard lock(mutex_);
  status_.pen = held;
  status_.nib_mm = nib_on_paper(pen.sample, pen.mapping);
  status_.latency_ms = milliseconds(now() - pen.sample.time.host);
  if (latencies_ms_.size() < latencies_kept) latencies_ms_.push_back(status_.latency_ms);
}

void LivePainting::publish() {
  Painting& painting = history_.painting();
  LiveStatus status;
  status.step = history_.step();
  status.brush = painting.brush(PenEnd::tip).shape();
  status.hair = seen_tufts(painting.brush(PenEnd::tip));
  status.insides = insides_of(painting.brush(PenEnd::tip));
  status.unconverged = painting.solves().unconverged;
  status.can_undo = history_.can_undo();
  status.can_redo = history_.can_redo();
  {
    const std::lock_guard lock(mutex_);
    status.step_ms = status_.step_ms;
    status.latency_ms = status_.latency_ms;
    status.pen = status_.pen;
    status.nib_mm = status_.nib_mm;
    status_ = std::move(status);
    if (changes_ || looking_) return;  // the window has not taken the last ones yet
    looking_ = true;
  }
  painting.look_later([this](const Ink& ink) { look(ink); });
}

// On the ink's thread.
void LivePainting::look(const Ink& ink) {
  const CellRect wet = ink.active_rect();
  CellRect cells;
  {
    const std::lock_guard lock(mutex_);
    // What was wet when the last pass over the sheet began may have dried since.
    if (empty(unshown_))
      unshown_ = united(std::exchange(was_wet_, wet), wet);
    else
      was_wet_ = united(was_wet_, wet);
    cells = unshown_;
    if (!empty(cells)) cells.rows = std::min(cells.rows, std::max(1, cells_a_picture / cells.columns));
    unshown_.bottom += cells.rows;
    unshown_.rows -= cells.rows;
  }
  std::optional<InkRegion> region;
  if (!empty(cells)) region = ink.read(cells);
  const std::lock_guard lock(mutex_);
  looking_ = false;
  changes_ = std::move(region);
}

void LivePainting::serve() try { paint(); } catch (const std::bad_alloc&) {
  fail({Fault::storage, "not enough memory to paint on; give a smaller --size-mm or a larger --cell-mm"});
} catch (const std::runtime_error& error) {
  fail({Fault::unsupported, error.what()});
}

void LivePainting::begin() {
  {
    const std::lock_guard lock(mutex_);
    started_ = true;
  }
  begun_.notify_one();
}

void LivePainting::fail(Error error) {
  {
    const std::lock_guard lock(mutex_);
    failed_ = std::move(error);
  }
  begun_.notify_one();
}

std::optional<Error> LivePainting::failed() const {
  const std::lock_guard lock(mutex_);
  return failed_;
}

void LivePainting::paint() {
  ask_for(Precedence::brush);
  const double step_s = history_.painting().step_s();
  // The memory of the first snapshot and the first pictures is touched before the clock starts.
  history_.painting().look_later([this](const Ink& ink) { look(ink); });
  (void)history_.painting().ink();
  begin();
  LiveClock::time_point start = LiveClock::now();
  LiveClock::time_point next_picture = start;
  std::vector<LiveInput> inputs;
  while (true) {
    const auto due = start + std::chrono::duration_cast<LiveClock::duration>(std::chrono::duration<double>(
                                 static_cast<double>(history_.step() + 1) * step_s));
    const bool behind = history_.painting().behind() > 0;
    bool stopping = false;
    {
      std::unique_lock lock(mutex_);
      wake_.wait_until(lock, behind ? std::max(due, LiveClock::now() + soon) : due,
                       [this] { return stopping_ || !queue_.empty(); });
      stopping = stopping_;
      std::swap(inputs, queue_);
    }
    for (const LiveInput& input : inputs) apply(input);
    inputs.clear();
    if (stopping) return;

    const auto before = LiveClock::now();
    if (before >= due && history_.painting().behind() == 0) {
      const std::vector<double> took = history_.painting().step_ms();
      if (!took.empty()) {
        const std::lock_guard lock(mutex_);
        status_.step_ms = took.back();
      }
      history_.advance_to(history_.step() + 1);
    }
    const double behind_s = std::chrono::duration<double>(before - due).count();
    if (behind_s > patience_s) start += before - due;
    if (before >= next_picture) {
      publish();
      next_picture = before + between_pictures;
    }
  }
}

LiveStatus LivePainting::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

std::optional<InkRegion> LivePainting::take_changes() {
  const std::lock_guard lock(mutex_);
  return std::exchange(changes_, std::nullopt);
}

History& LivePainting::stop() {
  if (thread_.joinable()) {
    {
      const std::lock_guard lock(mutex_);
      stopping_ = true;
    }
    wake_.notify_one();
    thread_.join();
    // A look at the paper may still be on its way.
    try {
      (void)history_.painting().ink();
    } catch (const std::exception& error) {
      if (!failed_) failed_ = Error{Fault::unsupported, error.what()};
    }
  }
  return history_;
}

}  // namespace fude
