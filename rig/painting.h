// A painting: one sheet, the brushes over it and the simulated clock. The same inputs at the same
// steps give the same picture, live or replayed: everything that happens goes through here.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <vector>

#include "capture/session.h"
#include "rig/ink_thread.h"
#include "rig/paint_box.h"
#include "rig/snapshot_memory.h"
#include "signal/action.h"
#include "signal/brush_input.h"
#include "signal/contact_model.h"
#include "signal/result.h"
#include "sim/brush/brush.h"
#include "sim/ink/ink.h"

namespace fude {

struct PaintingSetup {
  BrushSpec brush;
  InkSetup ink;
  // What both ends of the pen start with: ink ground thick, as for writing. The rubber end holds water only.
  LoadBrush load{0.8F, {1.2F, 0, 0, 0.4F}};
  bool endless = false;  // --ink endless: the brush stays full
  std::uint64_t seed = 1;
  std::vector<PlacedSpot> spots;  // of the palette beside the paper
};

// The two ends of a pen are two brushes: the tip carries ink, the rubber end clear water.
enum class PenEnd : std::uint8_t { tip, rubber };
inline constexpr std::size_t pen_ends = 2;

struct SolveCounts {
  std::int64_t solves = 0;
  std::int64_t unconverged = 0;
  double last_us = 0;   // of the wall: the last sample's solves and footprints
  Wrench last_on_hand;  // what the brush did to the hand at the last sample
};

// All of a painting's state between two steps; restoring it is exact.
struct PaintingState {
  Step step = 0;
  std::shared_future<InkSnapshot> ink;  // copied behind the painter
  std::vector<BrushState> brushes;
  struct Due {
    Step at = 0;
    PenEnd end{};
    Exchange exchange;
  };
  std::deque<Due> due;  // answered, not yet applied
  struct Asked {
    Step at = 0;  // when the answer is to be applied
    PenEnd end{};
  };
  std::map<std::uint64_t, Asked> unanswered;  // by event
  std::uint64_t next_event = 1;
};

// One thread at a time.
class Painting {
 public:
  static Result<Painting> open(const PaintingSetup& setup);
  // On an ink that is open already.
  Painting(const PaintingSetup& setup, std::unique_ptr<Ink> ink);

  double step_s() const { return ink_->step_s(); }
  Step step() const { return step_; }

  // Steps the ink up to `step`, behind the caller; a step that is past already changes nothing.
  void advance_to(Step step);

  // Steps that the ink has still to do.
  int behind() const { return ink_->behind(); }
  // Milliseconds of the wall that each step took, of those done since the last call.
  std::vector<double> step_ms() { return ink_->step_ms(); }

  // One sample of the brush, at the present step. Says whether hair touches the paper. Over a spot of the
  // palette (where the handle's axis meets the plane of the paper) the brush goes there instead.
  bool move(PenEnd end, const BrushInput& input);

  // Ink from anywhere: the event gets its number and time. Nobody is told what the paper refused.
  std::uint64_t pour(InkEvent event);

  // Loading, reshaping and drying; Undo and Redo belong to the history.
  void act(const Action& action);

  PaintingState save();
  void restore(const PaintingState& state);

  // The ink at the present step: waits for it.
  Ink& ink() { return ink_->caught_up(); }
  const Ink& ink() const { return ink_->caught_up(); }
  // Runs `look` on the ink's thread when it has come to the present step.
  void look_later(std::function<void(const Ink&)> look) { ink_->post(std::move(look)); }
  const Brush& brush(PenEnd end) const { return brushes_[static_cast<std::size_t>(end)]; }
  const SolveCounts& solves() const { return solves_; }

 private:
  void note(const std::vector<Exchange>& answers);
  void give_back_what_is_due();

  std::unique_ptr<SnapshotMemory> memory_;
  std::unique_ptr<InkThread> ink_;
  std::vector<Brush> brushes_;
  std::vector<PlacedSpot> spots_;
  std::deque<PaintingState::Due> due_;
  std::map<std::uint64_t, PaintingState::Asked> unanswered_;
  std::uint64_t next_event_ = 1;
  Step step_ = 0;
  Step exchange_delay_ = 1;
  SolveCounts solves_;
};

}  // namespace fude
