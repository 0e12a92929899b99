#include "calibration/rig_hypotheses.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "calibration/fusion/motion_state.h"

namespace fude {
namespace {

constexpr double touch_mm = 0.35;
constexpr double slid_mm = 20, turned_rad = 0.09, tip_mm = 6;

using Vector9 = Eigen::Matrix<double, 9, 1>;  // shift, turn, tip

// What each freedom is expected to be; 0: it is none.
struct Model {
  RigMoved moved;
  double slide_mm, lift_mm, turn_rad, tilt_rad, tip_mm;
  double prior;

  Vector9 scales() const {
    Vector9 s;
    s << slide_mm, slide_mm, lift_mm, tilt_rad, tilt_rad, turn_rad, tip_mm, tip_mm, tip_mm;
    return s;
  }
};
// A sheet that was only shifted, as on another pad, is as likely as a tip that was: a handle that always
// leaned alike tells neither from the other.
constexpr Model models[] = {
    {RigMoved::paper, tip_mm, tip_mm, 0, 0, 0, 1},
    {RigMoved::paper, slid_mm, 0, turned_rad, 0, 0, 1},
    {RigMoved::tracker, slid_mm, slid_mm, turned_rad, turned_rad, 0, 1},
    {RigMoved::tip, 0, 0, 0, 0, tip_mm, 1},
    {RigMoved::both, slid_mm, 0, turned_rad, 0, tip_mm, 0.05},
    {RigMoved::both, slid_mm, slid_mm, turned_rad, turned_rad, tip_mm, 0.05},
};

RigMotion motion_of(const Vector9& v) { return {v.head<3>(), v.segment<3>(3), v.tail<3>()}; }

// Of all touches, one below the other, in standard deviations.
Eigen::VectorXd residuals(std::span<const KnownTouch> touches, const Eigen::Vector3d& middle,
                          const Vector9& at) {
  const RigMotion motion = motion_of(at);
  const Eigen::Quaterniond turn = rotation_of(motion.turn_rad);
  Eigen::VectorXd r(3 * Eigen::Index(touches.size()));
  for (std::size_t i = 0; i < touches.size(); ++i) {
    const KnownTouch& touch = touches[i];
    const Eigen::Vector3d there =
        middle + turn * (touch.then_mm - middle) + motion.shift_mm - touch.paper_turned * motion.tip_mm;
    Eigen::Vector3d off = (touch.now_mm - there) / touch_mm;
    if (touch.height_only) off.head<2>().setZero();
    r.segment<3>(3 * Eigen::Index(i)) = off;
  }
  return r;
}

struct Weighed {
  RigHypothesis hypothesis;
  double evidence = 0;  // its logarithm
};

// Gauss and Newton, in units of what is expected of each freedom.
Weighed weighed(const Model& model, std::span<const KnownTouch> touches, const Eigen::Vector3d& middle) {
  const Vector9 scales = model.scales();
  Vector9 unit = Vector9::Zero();
  Eigen::MatrixXd information;
  Eigen::VectorXd r;
  constexpr int steps = 8;
  constexpr double nudge = 1e-5;
  for (int step = 0;; ++step) {
    r = residuals(touches, middle, scales.cwiseProduct(unit));
    Eigen::MatrixXd slopes(r.size(), 9);
    for (Eigen::Index k = 0; k < 9; ++k) {
      Vector9 more = unit, less = unit;
      more(k) += nudge;
      less(k) -= nudge;
      slopes.col(k) = (residuals(touches, middle, scales.cwiseProduct(more)) -
                       residuals(touches, middle, scales.cwiseProduct(less))) /
                      (2 * nudge);
    }
    information = slopes.transpose() * slopes + Eigen::MatrixXd::Identity(9, 9);
    if (step == steps) break;
    unit -= information.ldlt().solve(slopes.transpose() * r + unit);
  }
  Weighed found;
  found.hypothesis = {model.moved, motion_of(scales.cwiseProduct(unit)), 0,
                      touch_mm * std::sqrt(r.squaredNorm() / double(touches.size()))};
  found.evidence = std::log(model.prior) - (r.squaredNorm() + unit.squaredNorm()) / 2 -
                   information.ldlt().vectorD().array().log().sum() / 2;
  return found;
}

}  // namespace

std::vector<RigHypothesis> rig_hypotheses(std::span<const KnownTouch> touches,
                                          const Eigen::Vector3d& paper_middle_mm) {
  std::vector<Weighed> all;
  for (const Model& model : models) all.push_back(weighed(model, touches, paper_middle_mm));
  std::ranges::sort(all, std::greater(), &Weighed::evidence);
  double sum = 0;
  for (const Weighed& w : all) sum += std::exp(w.evidence - all.front().evidence);
  std::vector<RigHypothesis> hypotheses;
  for (Weighed& w : all) {
    w.hypothesis.probability = std::exp(w.evidence - all.front().evidence) / sum;
    const auto same = std::ranges::find(hypotheses, w.hypothesis.moved, &RigHypothesis::moved);
    if (same != hypotheses.end())
      same->probability += w.hypothesis.probability;
    else
      hypotheses.push_back(w.hypothesis);
  }
  std::ranges::stable_sort(hypotheses, std::greater(), &RigHypothesis::probability);
  return hypotheses;
}

}  // namespace fude
