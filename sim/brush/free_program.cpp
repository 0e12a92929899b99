#include "sim/brush/free_program.h"

namespace fude {
namespace {

auto index(int i) { return static_cast<std::size_t>(i); }

}  // namespace

FreeProgram::FreeProgram(const Program& whole) : whole_(whole) {
  for (int i = 0; i < whole.low.size(); ++i)
    if (whole.low[i] < whole.high[i]) free_[index(size_++)] = i;
  low = free_of(whole.low);
  high = free_of(whole.high);
  unit = free_of(whole.unit);
  small_energy = whole.small_energy;
  small_gradient = whole.small_gradient;
  small_violation = whole.small_violation;
}

void FreeProgram::evaluate(const Variables& free, Evaluation& at) const {
  Variables x(whole_.low.size());
  put_back(free, x);
  Evaluation all;
  whole_.evaluate(x, all);
  at.value = all.value;
  at.constraints = all.constraints;
  at.gradient = free_of(all.gradient);
  at.jacobian.resize(all.jacobian.rows(), size_);
  for (int i = 0; i < size_; ++i) at.jacobian.col(i) = all.jacobian.col(free_[index(i)]);
}

Variables FreeProgram::free_of(const Variables& x) const {
  Variables free(size_);
  for (int i = 0; i < size_; ++i) free[i] = x[free_[index(i)]];
  return free;
}

SquareMatrix FreeProgram::free_of(const SquareMatrix& hessian) const {
  SquareMatrix free(size_, size_);
  for (int j = 0; j < size_; ++j)
    for (int i = 0; i < size_; ++i) free(i, j) = hessian(free_[index(i)], free_[index(j)]);
  return free;
}

void FreeProgram::put_back(const Variables& free, Variables& x) const {
  x = whole_.low;
  for (int i = 0; i < size_; ++i) x[free_[index(i)]] = free[i];
}

void FreeProgram::put_back(const SquareMatrix& free, SquareMatrix& hessian) const {
  const Variables alone = hessian.diagonal();
  hessian.setZero();
  hessian.diagonal() = alone;
  for (int j = 0; j < size_; ++j)
    for (int i = 0; i < size_; ++i) hessian(free_[index(i)], free_[index(j)]) = free(i, j);
}

}  // namespace fude
