#include "sim/brush/contact_force.h"

#include <Eigen/LU>
#include <vector>

#include "signal/elementary.h"

namespace fude {
namespace {

using Eigen::Vector3d;
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Motion = Eigen::Matrix<double, Eigen::Dynamic, 6>;  // what the six of the handle do to some unknowns

auto index(int i) { return static_cast<std::size_t>(i); }

constexpr double difference =
    1e-5;                         // of an unknown (rad, mm) or the handle (mm, rad), for central differences
constexpr double newtons = 1e-3;  // a millinewton
constexpr double holds = 1e-6;    // mN: a multiplier above it holds its constraint
constexpr double at_bound = 1e-9;

// Force and torque on the hand in mN and mN mm.
Vector6d wrench_of(const Skeleton& s, const NodeForces& pull) {
  Vector6d wrench = Vector6d::Zero();
  for (int k = 1; k <= s.segments; ++k) {
    const Vector3d& at_node = pull.at_node[index(k)];
    wrench.head<3>() -= at_node;
    wrench.tail<3>() -=
        (s.node[index(k)] - s.node[0]).cross(at_node) + s.lateral[index(k)].cross(pull.at_lateral[index(k)]);
  }
  return wrench;
}

Vector6d wrench_at(const Tuft& tuft, const FrozenStep& frozen, const Variables& x, const Multipliers& m) {
  const Skeleton skeleton = pose_skeleton(tuft, x, frozen.paper_from_handle);
  return wrench_of(skeleton, TuftProgram(tuft, frozen).paper_pull(x, skeleton, m));
}

// Shifted or turned by `amount` in one of the six directions.
FrozenStep moved(FrozenStep frozen, int direction, double amount) {
  if (direction < 3) {
    frozen.paper_from_handle.translation[direction] += amount;
    return frozen;
  }
  const auto [sine, cosine] = elementary::sine_cosine(0.5 * amount);
  Eigen::Quaterniond turn(cosine, 0, 0, 0);
  turn.vec()[direction - 3] = sine;
  frozen.paper_from_handle.rotation = turn * frozen.paper_from_handle.rotation;
  return frozen;
}

Variables lagrangian_gradient(const TuftProgram& program, const Variables& x, const Multipliers& m) {
  Evaluation at;
  program.evaluate(x, at);
  return at.gradient - at.jacobian.transpose() * m;
}

}  // namespace

Wrench contact_wrench(const Tuft& tuft, const FrozenStep& frozen, const Variables& x,
                      const Multipliers& multipliers) {
  const Vector6d wrench = newtons * wrench_at(tuft, frozen, x, multipliers);
  return {wrench.head<3>(), wrench.tail<3>()};
}

ContactModel contact_model(const Tuft& tuft, const FrozenStep& frozen, const Variables& x,
                           const Multipliers& multipliers) {
  const TuftProgram program(tuft, frozen);
  Evaluation at;
  program.evaluate(x, at);
  std::vector<int> free;
  for (int i = 0; i < x.size(); ++i)
    if (x[i] > program.low[i] + at_bound && x[i] < program.high[i] - at_bound) free.push_back(i);
  std::vector<int> held;
  for (int j = 0; j < multipliers.size(); ++j)
    if (multipliers[j] > holds) held.push_back(j);
  const auto n = static_cast<int>(free.size());
  const auto size = n + static_cast<int>(held.size());

  // The conditions of the minimum, differentiated: system · (dx, −dλ) = −by_handle · d(pose).
  Eigen::MatrixXd system = Eigen::MatrixXd::Zero(size, size);
  Motion by_handle = Motion::Zero(size, 6);
  for (int i = 0; i < n; ++i) {
    Variables ahead = x;
    Variables behind = x;
    ahead[free[index(i)]] += difference;
    behind[free[index(i)]] -= difference;
    const Variables change = (lagrangian_gradient(program, ahead, multipliers) -
                              lagrangian_gradient(program, behind, multipliers)) /
                             (2 * difference);
    for (int row = 0; row < n; ++row) system(row, i) = change[free[index(row)]];
    // A mixed derivative is one whichever way round: what x does to the wrench, the pose does to the
    // gradient.
    by_handle.row(i) =
        -(wrench_at(tuft, frozen, ahead, multipliers) - wrench_at(tuft, frozen, behind, multipliers)) /
        (2 * difference);
  }
  const Skeleton skeleton = pose_skeleton(tuft, x, frozen.paper_from_handle);
  const Vector6d without = wrench_of(skeleton, program.paper_pull(x, skeleton, 0 * multipliers));
  for (int j = n; j < size; ++j) {
    const int constraint = held[index(j - n)];
    for (int i = 0; i < n; ++i) system(i, j) = system(j, i) = at.jacobian(constraint, free[index(i)]);
    const Multipliers alone = Multipliers::Unit(multipliers.size(), constraint);
    by_handle.row(j) = wrench_of(skeleton, program.paper_pull(x, skeleton, alone)) - without;
  }

  Eigen::Matrix<double, 6, 6> stiffness;
  for (int direction = 0; direction < 6; ++direction)
    stiffness.col(direction) = -(wrench_at(tuft, moved(frozen, direction, difference), x, multipliers) -
                                 wrench_at(tuft, moved(frozen, direction, -difference), x, multipliers)) /
                               (2 * difference);
  if (size > 0) stiffness -= by_handle.transpose() * system.fullPivLu().solve(by_handle);

  ContactModel model;
  model.paper_from_handle = frozen.paper_from_handle;
  model.wrench = contact_wrench(tuft, frozen, x, multipliers);
  model.stiffness = newtons * stiffness;
  return model;
}

}  // namespace fude
