// A program without the unknowns that its bounds leave no room: a tuft that does not spread has ten fewer of
// twenty-nine, and the cost of a quadratic program goes as their cube.
#pragma once

#include <array>

#include "sim/brush/program.h"

namespace fude {

class FreeProgram : public Program {
 public:
  // `whole` must outlive this. The unknowns without room are held where their bounds say.
  explicit FreeProgram(const Program& whole);

  bool is_whole() const { return size_ == static_cast<int>(whole_.low.size()); }

  // Value and constraints are those of the whole, derivatives those by the free unknowns.
  void evaluate(const Variables& free, Evaluation& at) const override;

  Variables free_of(const Variables& x) const;
  SquareMatrix free_of(const SquareMatrix& hessian) const;

  // Back into the whole: unknowns without room stand at their bounds, and in a Hessian they have nothing to
  // do with the others, which keeps it positive definite.
  void put_back(const Variables& free, Variables& x) const;
  void put_back(const SquareMatrix& free, SquareMatrix& hessian) const;

 private:
  const Program& whole_;
  int size_ = 0;
  std::array<int, max_variables> free_{};
};

}  // namespace fude
