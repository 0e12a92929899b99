// Undo: a stroke is taken back by the nearest snapshot before it and the inputs after that, run
// again. Memory is bounded by how many snapshots are kept; with none, all is run from the start.
#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <variant>
#include <vector>

#include "rig/painting.h"

namespace fude {

// What moved the painting: a brush sample or an action.
struct BrushMove {
  PenEnd end{};
  BrushInput input;
};
using PaintingInput = std::variant<BrushMove, Action>;

class History {
 public:
  explicit History(Painting painting, std::size_t snapshots_kept);

  // The clock of the session only goes forward; the painting's own goes back with an undo.
  Step step() const { return painting_.step() + offset_; }
  void advance_to(Step session_step);

  // At the present step. A contact after none, a load and a drying each begin what one undo takes
  // back; Undo and Redo with nothing to take or bring back change nothing.
  void apply(const PaintingInput& input);

  bool can_undo() const { return !marks_.empty(); }
  bool can_redo() const { return !undone_.empty(); }
  Painting& painting() { return painting_; }
  const Painting& painting() const { return painting_; }

 private:
  struct Logged {
    Step step = 0;  // of the painting
    PaintingInput input;
  };
  struct Mark {
    std::size_t logged = 0;  // inputs before it
    Step step = 0;
    std::optional<PaintingState> state;
  };
  struct Undone {
    std::vector<Logged> inputs;
    Step until = 0;
  };
  void mark();
  void run(const Logged& logged);
  void go_back_to(const Mark& mark);
  void undo();
  void redo();

  Painting painting_;
  PaintingState start_;
  std::size_t snapshots_kept_;
  std::vector<Logged> log_;
  std::vector<Mark> marks_;
  std::vector<Undone> undone_;
  Step offset_ = 0;
  bool in_contact_ = false;
};

}  // namespace fude
