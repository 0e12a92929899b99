#include "rig/history.h"

#include <algorithm>
#include <utility>

namespace fude {

History::History(Painting painting, std::size_t snapshots_kept)
    : painting_(std::move(painting)), start_(painting_.save()), snapshots_kept_(snapshots_kept) {}

void History::advance_to(Step session_step) { painting_.advance_to(session_step - offset_); }

void History::mark() {
  undone_.clear();
  marks_.push_back({log_.size(), painting_.step(), std::nullopt});
  if (snapshots_kept_ == 0) return;
  marks_.back().state = painting_.save();
  const auto kept =
      std::count_if(marks_.begin(), marks_.end(), [](const Mark& m) { return m.state.has_value(); });
  if (static_cast<std::size_t>(kept) > snapshots_kept_)
    std::find_if(marks_.begin(), marks_.end(), [](const Mark& m) {
      return m.state.has_value();
    })->state.reset();
}

void History::run(const Logged& logged) {
  painting_.advance_to(logged.step);
  if (const auto* move = std::get_if<BrushMove>(&logged.input))
    painting_.move(move->end, move->input);
  else
    painting_.act(std::get<Action>(logged.input));
}

void History::apply(const PaintingInput& input) {
  if (const auto* action = std::get_if<Action>(&input)) {
    if (std::holds_alternative<Undo>(action->what)) return undo();
    if (std::holds_alternative<Redo>(action->what)) return redo();
    mark();
  } else {
    const bool touches = std::get<BrushMove>(input).input.in_contact;
    if (touches && !in_contact_) mark();
    in_contact_ = touches;
  }
  log_.push_back({painting_.step(), input});
  run(log_.back());
}

void History::go_back_to(const Mark& mark) {
  const Mark* nearest = nullptr;
  for (const Mark& m : marks_)
    if (m.state && m.logged <= mark.logged) nearest = &m;
  if (mark.state) nearest = &mark;
  painting_.restore(nearest ? *nearest->state : start_);
  for (std::size_t i = nearest ? nearest->logged : 0; i < mark.logged; ++i) run(log_[i]);
  painting_.advance_to(mark.step);
}

void History::undo() {
  if (marks_.empty()) return;
  const Step session_step = step();
  const Mark mark = std::move(marks_.back());
  marks_.pop_back();
  Undone undone{{log_.begin() + static_cast<std::ptrdiff_t>(mark.logged), log_.end()}, painting_.step()};
  go_back_to(mark);
  log_.resize(mark.logged);
  undone_.push_back(std::move(undone));
  offset_ = session_step - painting_.step();
  in_contact_ = false;
}

void History::redo() {
  if (undone_.empty()) return;
  const Step session_step = step();
  std::vector<Undone> rest = std::move(undone_);
  const Undone again = std::move(rest.back());
  rest.pop_back();
  // The paper may have aged since the undo: what is brought back follows at its old distances.
  const Step later =
      again.inputs.empty() ? 0 : std::max<Step>(0, painting_.step() - again.inputs.front().step);
  mark();
  undone_ = std::move(rest);
  for (Logged logged : again.inputs) {
    logged.step += later;
    log_.push_back(logged);
    run(log_.back());
  }
  painting_.advance_to(again.until + later);
  offset_ = session_step - painting_.step();
  in_contact_ = false;
}

}  // namespace fude
