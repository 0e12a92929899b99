#include "rig/painting.h"

#include <chrono>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "sim/ink/sheet_grain.h"

namespace fude {
namespace {

// The time after which the brush learns what the paper took, so that no read-back stalls a frame.
constexpr double exchange_delay_s = 1.0 / 120;

Duration session_time(Step step, double step_s) {
  return Duration(static_cast<std::int64_t>(std::llround(static_cast<double>(step) * step_s * 1e9)));
}

// Where the handle's axis meets the plane of the paper.
const PlacedSpot* spot_under(const std::vector<PlacedSpot>& spots, const BrushInput& input) {
  const Eigen::Vector3d axis = input.paper_from_handle.rotation * Eigen::Vector3d::UnitZ();
  if (spots.empty() || input.origin == PoseOrigin::none || !(axis.z() > 0.05)) return nullptr;
  const Eigen::Vector3d& root = input.paper_from_handle.translation;
  const Eigen::Vector3d nib = root - root.z() / axis.z() * axis;
  return spot_at(spots, nib.x(), nib.y());
}

}  // namespace

Result<Painting> Painting::open(const PaintingSetup& setup) {
  auto ink = open_ink(setup.ink);
  if (!ink) return tl::unexpected(ink.error());
  return Painting(setup, std::move(*ink));
}

Painting::Painting(const PaintingSetup& setup, std::unique_ptr<Ink> ink)
    : memory_(std::make_unique<SnapshotMemory>()), ink_(std::make_unique<InkThread>(std::move(ink))) {
  const auto grain = std::make_shared<SheetGrain>(setup.ink.paper, setup.ink.seed);
  spots_ = setup.spots;
  brushes_.assign(pen_ends, Brush(setup.brush, setup.seed));
  LoadBrush load = setup.load;
  for (Brush& brush : brushes_) {
    brush.load(load.wetness, load.strength);
    brush.set_endless(setup.endless);
    brush.expect_film(setup.ink.paper.film);
    brush.paint_over(grain);
    load.strength = {};
  }
  exchange_delay_ = static_cast<Step>(std::ceil(exchange_delay_s / ink_->step_s() - 1e-9));
}

void Painting::advance_to(Step step) {
  for (; step_ < step; ++step_) ink_->step();
}

void Painting::note(const std::vector<Exchange>& answers) {
  for (const Exchange& exchange : answers) {
    const auto waiting = unanswered_.find(exchange.event);
    if (waiting == unanswered_.end()) continue;
    due_.push_back({waiting->second.at, waiting->second.end, exchange});
    unanswered_.erase(waiting);
  }
}

void Painting::give_back_what_is_due() {
  note(ink_->answers());
  // Events are answered in their order: the first that waits is the first that is due.
  while (!unanswered_.empty() && unanswered_.begin()->second.at <= step_) {
    const std::vector<Exchange> answers = ink_->wait_for_answers();
    if (answers.empty()) throw std::logic_error("the ink has not answered an event that it was given");
    note(answers);
  }
  while (!due_.empty() && due_.front().at <= step_) {
    brushes_[static_cast<std::size_t>(due_.front().end)].take(due_.front().exchange);
    due_.pop_front();
  }
}

std::uint64_t Painting::pour(InkEvent event) {
  event.id = next_event_++;
  event.at = session_time(step_, step_s());
  const std::uint64_t id = event.id;
  ink_->post([event = std::move(event)](Ink& ink) { ink.apply(event); });
  return id;
}

bool Painting::move(PenEnd end, const BrushInput& input) {
  give_back_what_is_due();
  if (const PlacedSpot* spot = spot_under(spots_, input)) {
    brushes_[static_cast<std::size_t>(end)].visit(input, spot->spot);
    return false;
  }
  const auto start = std::chrono::steady_clock::now();
  BrushFrame frame = brushes_[static_cast<std::size_t>(end)].move(input);
  solves_.last_us =
      std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count();
  ++solves_.solves;
  solves_.unconverged += !frame.solve.converged;
  solves_.last_on_hand = frame.solve.on_hand;
  if (!frame.deposit) return false;
  unanswered_[pour({.what = std::move(*frame.deposit)})] = {step_ + exchange_delay_, end};
  return true;
}

void Painting::act(const Action& action) {
  give_back_what_is_due();
  if (const auto* care = std::get_if<BrushCare>(&action.what))
    brushes_[static_cast<std::size_t>(PenEnd::tip)].tend(*care);
  if (std::holds_alternative<ReshapeBrush>(action.what))
    for (Brush& brush : brushes_) brush.reshape();
  if (std::holds_alternative<DrySheet>(action.what)) pour({.what = DryPaper{}});
}

PaintingState Painting::save() {
  // What has been answered is in the brush's hands; what has not, the ink's snapshot holds.
  if (!unanswered_.empty()) (void)ink_->caught_up();
  note(ink_->answers());
  auto copied = std::make_shared<std::promise<InkSnapshot>>();
  PaintingState state{step_, copied->get_future().share(), {}, due_, unanswered_, next_event_};
  ink_->post([copied, memory = memory_.get()](const Ink& ink) {
    copied->set_value(ink.snapshot(memory->take()));
    memory->prepare(ink.active_cells() + ink.active_cells() / 4);
  });
  for (const Brush& brush : brushes_) state.brushes.push_back(brush.state());
  return state;
}

void Painting::restore(const PaintingState& state) {
  step_ = state.step;
  Ink& ink = ink_->caught_up();
  ink.restore(state.ink.get());
  (void)ink_->answers();
  for (std::size_t i = 0; i < brushes_.size(); ++i) brushes_[i].restore(state.brushes[i]);
  due_ = state.due;
  unanswered_ = state.unanswered;
  next_event_ = state.next_event;
}

}  // namespace fude
