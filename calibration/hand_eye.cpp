#include "calibration/hand_eye.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <random>

#include "calibration/block_jackknife.h"
#include "calibration/fusion/motion_state.h"
#include "calibration/report.h"

namespace fude {
namespace {

constexpr int turn_x = 0, shift_x = 3, turn_y = 6, shift_y = 9, lag = 12;
constexpr double believed_lag_s = 0.02;
constexpr double lever_m = 0.1;  // at which a turn counts as a shift, where both are judged as one
constexpr double finest_m = 1e-7, finest_rad = 1e-7;

using Equations = NormalEquations<hand_eye_unknowns>;
using Unknowns = Eigen::Matrix<double, hand_eye_unknowns, 1>;
using Rows = Eigen::Matrix<double, 3, hand_eye_unknowns>;

// The rotation nearest to a matrix that is one but for noise and a factor.
Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& m) {
  const auto svd =
      (m.determinant() < 0 ? Eigen::Matrix3d(-m) : m).jacobiSvd(Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d sign = Eigen::Vector3d::Ones();
  sign(2) = svd.matrixU().determinant() * svd.matrixV().determinant() < 0 ? -1 : 1;
  return svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
}

struct Scales {
  double shift_m = 0, turn_rad = 0;  // standard deviations of a coordinate
};

Scales scales_of(const std::vector<HandEyeResidual>& residuals, std::size_t stride = 1) {
  constexpr double median_of_three = 1.538;
  std::vector<double> shifts, turns;
  for (std::size_t i = 0; i < residuals.size(); i += stride) {
    shifts.push_back(residuals[i].shift_m.norm());
    turns.push_back(residuals[i].turn_rad.norm());
  }
  return {std::max(quantile(shifts, 0.5) / median_of_three, finest_m),
          std::max(quantile(turns, 0.5) / median_of_three, finest_rad)};
}

std::vector<HandEyeResidual> residuals_of(const HandEye& fit, std::span<const MotionPair> pairs,
                                          std::size_t stride = 1) {
  std::vector<HandEyeResidual> all;
  for (std::size_t i = 0; i < pairs.size(); i += stride) all.push_back(residual_of(fit, pairs[i]));
  return all;
}

HandEye nearest_to_half(std::span<const MotionPair> pairs) {
  constexpr int draws = 100;
  constexpr std::size_t draw_size = 4, most_judges = 400;
  const std::size_t stride = pairs.size() / most_judges + 1;
  const auto score = [&](const HandEye& fit) {
    const Scales s = scales_of(residuals_of(fit, pairs, stride));
    return s.shift_m + lever_m * s.turn_rad;
  };
  HandEye best = closed_hand_eye(pairs);
  double least = score(best);
  std::mt19937 random(1);
  std::vector<MotionPair> some(draw_size);
  for (int draw = 0; draw < draws; ++draw) {
    for (MotionPair& pair : some) pair = pairs[random() % pairs.size()];
    const HandEye fit = closed_hand_eye(some);
    if (const double here = score(fit); here < least) {
      least = here;
      best = fit;
    }
  }
  return best;
}

void add_pair(Equations& equations, const HandEye& fit, const MotionPair& pair, const Scales& scales) {
  const HandEyeResidual r = residual_of(fit, pair);
  const Eigen::Matrix3d seen = pair.seen.rotation.toRotationMatrix();
  const Eigen::Quaterniond& to_tracker = fit.tracker_from_other.rotation;
  Rows turn = Rows::Zero(), shift = Rows::Zero();
  turn.middleCols<3>(turn_x) = seen;
  turn.middleCols<3>(turn_y) = -Eigen::Matrix3d::Identity();
  turn.col(lag) = -(to_tracker * (pair.other.rotation * pair.other_turn_radps));
  shift.middleCols<3>(shift_x) = seen;
  shift.middleCols<3>(turn_y) = cross_matrix(to_tracker * pair.other.translation);
  shift.middleCols<3>(shift_y) = -Eigen::Matrix3d::Identity();
  shift.col(lag) = -(to_tracker * pair.other_velocity_mps);
  equations.add<3>(r.turn_rad, turn, 1 / (scales.turn_rad * scales.turn_rad));
  equations.add<3>(r.shift_m, shift, 1 / (scales.shift_m * scales.shift_m));
}

HandEye moved(const HandEye& fit, const Unknowns& step) {
  HandEye to = fit;
  to.tool_from_other.rotation =
      (rotation_of(step.segment<3>(turn_x)) * fit.tool_from_other.rotation).normalized();
  to.tool_from_other.translation += step.segment<3>(shift_x);
  to.tracker_from_other.rotation =
      (rotation_of(step.segment<3>(turn_y)) * fit.tracker_from_other.rotation).normalized();
  to.tracker_from_other.translation += step.segment<3>(shift_y);
  to.lag_s += step(lag);
  return to;
}

Equations belief(const HandEye& fit) {
  Equations equations;
  const double weight = 1 / (believed_lag_s * believed_lag_s);
  equations.information(lag, lag) = weight;
  equations.gradient(lag) = -weight * fit.lag_s;
  return equations;
}

std::vector<bool> agreeing(const std::vector<HandEyeResidual>& residuals, const Scales& scales) {
  constexpr double gate = 5;
  std::vector<bool> agrees(residuals.size());
  for (std::size_t i = 0; i < residuals.size(); ++i)
    agrees[i] = residuals[i].shift_m.norm() < gate * scales.shift_m &&
                residuals[i].turn_rad.norm() < gate * scales.turn_rad;
  return agrees;
}

// Of the pairs that agree, a coordinate each.
Scales spread_of(const std::vector<HandEyeResidual>& residuals, const std::vector<bool>& agrees) {
  double shift = 0, turn = 0, n = 0;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    if (!agrees[i]) continue;
    shift += residuals[i].shift_m.squaredNorm();
    turn += residuals[i].turn_rad.squaredNorm();
    ++n;
  }
  const double freedom = std::max(1.0, 3 * n - hand_eye_unknowns / 2.0);
  return {std::max(std::sqrt(shift / freedom), finest_m), std::max(std::sqrt(turn / freedom), finest_rad)};
}

// Whichever says less.
Eigen::Matrix<double, 6, 6> larger(const Eigen::Matrix<double, 6, 6>& a,
                                   const Eigen::Matrix<double, 6, 6>& b) {
  return a.bottomRightCorner<3, 3>().trace() > b.bottomRightCorner<3, 3>().trace() ? a : b;
}

}  // namespace

HandEyeResidual residual_of(const HandEye& fit, const MotionPair& pair) {
  Pose<OtherTracker, OtherTool> other = pair.other;
  other.rotation = other.rotation * rotation_of(fit.lag_s * pair.other_turn_radps);
  other.translation += fit.lag_s * pair.other_velocity_mps;
  const auto one = pair.seen * fit.tool_from_other;
  const auto two = fit.tracker_from_other * other;
  return {one.translation - two.translation, turn_of(one.rotation * two.rotation.conjugate())};
}

HandEye closed_hand_eye(std::span<const MotionPair> pairs) {
  // R_seen·X = Y·R_other is (R_other ⊗ R_seen)·vec X = vec Y: the two are singular vectors of the sum.
  Eigen::Matrix<double, 9, 9> sum = Eigen::Matrix<double, 9, 9>::Zero();
  for (const MotionPair& pair : pairs) {
    const Eigen::Matrix3d a = pair.seen.rotation.toRotationMatrix(),
                          b = pair.other.rotation.toRotationMatrix();
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) sum.block<3, 3>(3 * i, 3 * j) += b(i, j) * a;
  }
  const Eigen::JacobiSVD<Eigen::Matrix<double, 9, 9>> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
  HandEye fit;
  const Eigen::Matrix<double, 9, 1> x = svd.matrixV().col(0), y = svd.matrixU().col(0);
  const Eigen::Matrix3d turn_from = nearest_rotation(Eigen::Map<const Eigen::Matrix3d>(x.data()));
  const Eigen::Matrix3d turn_to = nearest_rotation(Eigen::Map<const Eigen::Matrix3d>(y.data()));
  fit.tool_from_other.rotation = Eigen::Quaterniond(turn_from).normalized();
  fit.tracker_from_other.rotation = Eigen::Quaterniond(turn_to).normalized();
  NormalEquations<6> equations;
  for (const MotionPair& pair : pairs) {
    Eigen::Matrix<double, 3, 6> rows;
    rows << pair.seen.rotation.toRotationMatrix(), -Eigen::Matrix3d::Identity();
    equations.add<3>(pair.seen.translation - turn_to * pair.other.translation, rows);
  }
  const Eigen::Matrix<double, 6, 1> shift =
      equations.information.completeOrthogonalDecomposition().solve(equations.gradient);
  fit.tool_from_other.translation = shift.head<3>();
  fit.tracker_from_other.translation = shift.tail<3>();
  return fit;
}

double length_ratio(std::span<const MotionPair> pairs, const HandEye& fit) {
  NormalEquations<7> equations;
  for (const MotionPair& pair : pairs) {
    Eigen::Matrix<double, 3, 7> rows;
    rows << pair.seen.rotation.toRotationMatrix(), -Eigen::Matrix3d::Identity(),
        -(fit.tracker_from_other.rotation * pair.other.translation);
    equations.add<3>(pair.seen.translation, rows);
  }
  return equations.information.completeOrthogonalDecomposition().solve(equations.gradient)(6);
}

RobustHandEye robust_hand_eye(std::span<const MotionPair> pairs) {
  constexpr std::size_t blocks = 20;
  RobustHandEye robust;
  HandEye& fit = robust.fit;
  fit = nearest_to_half(pairs);
  Scales scales;
  for (int round = 0; round < 30; ++round) {
    const auto residuals = residuals_of(fit, pairs);
    scales = scales_of(residuals);
    std::vector<bool> agrees = agreeing(residuals, scales);
    const bool settled = round > 3 && agrees == robust.agrees;
    robust.agrees = std::move(agrees);
    if (settled) break;
    Equations equations = belief(fit);
    for (std::size_t i = 0; i < pairs.size(); ++i)
      if (robust.agrees[i]) add_pair(equations, fit, pairs[i], scales);
    fit = moved(fit, equations.step());
  }

  const auto residuals = residuals_of(fit, pairs);
  scales = spread_of(residuals, robust.agrees);
  std::vector<Equations> of_block(blocks);
  Equations all = belief(fit);
  for (std::size_t i = 0; i < pairs.size(); ++i)
    if (robust.agrees[i]) add_pair(of_block[block_of(i, pairs.size(), blocks)], fit, pairs[i], scales);
  for (Equations& block : of_block) {
    all += block;
    block.information(lag, lag) += 1 / (believed_lag_s * believed_lag_s * double(blocks));
  }
  const auto steps = steps_without<hand_eye_unknowns>(of_block);
  const Eigen::Matrix<double, hand_eye_unknowns, hand_eye_unknowns> own =
      all.information.ldlt().solve(Eigen::Matrix<double, hand_eye_unknowns, hand_eye_unknowns>::Identity());
  const auto jackknife = jackknife_covariance<hand_eye_unknowns>(steps);
  robust.covariance_x = larger(own.block<6, 6>(turn_x, turn_x), jackknife.block<6, 6>(turn_x, turn_x));
  robust.covariance_y = larger(own.block<6, 6>(turn_y, turn_y), jackknife.block<6, 6>(turn_y, turn_y));
  robust.lag_deviation_s = std::sqrt(std::max(own(lag, lag), jackknife(lag, lag)));
  for (std::size_t i = 0; i < pairs.size(); ++i)
    robust.left_out.push_back(residual_of(moved(fit, steps[block_of(i, pairs.size(), blocks)]), pairs[i]));
  return robust;
}

}  // namespace fude
