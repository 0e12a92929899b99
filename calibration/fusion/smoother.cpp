#include "calibration/fusion/smoother.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace fude {
namespace {

constexpr double node_period_s = 0.02;  // between two nodes an error changes along a line
constexpr double piece_s = 20, overlap_s = 4;

// A sample between two nodes, as the forward pass had it.
struct Passed {
  Timestamp time{};
  FusionState state{};
  bool placed = false;
  MotionState motion;  // without its covariance
  Eigen::Vector3d rate_radps = Eigen::Vector3d::Zero();
};

// Where a correction was made, or none for a while.
struct Node {
  Timestamp time{};
  MotionState predicted, corrected;
  ErrorMatrix transition;      // from the node before, as corrected there
  bool broken = false;         // anchored: what came before says nothing of what follows
  std::vector<Passed> passed;  // since the node before
};

// P⁻¹ M where some of P's rows may be zero: what is known exactly stays so.
ErrorMatrix solve(const ErrorMatrix& covariance, const ErrorMatrix& right) {
  ErrorVector scale = covariance.diagonal().cwiseMax(0).cwiseSqrt();
  for (double& s : scale) s = s > 0 ? 1 / s : 1;
  ErrorMatrix scaled = scale.asDiagonal() * covariance * scale.asDiagonal();
  scaled.diagonal().array() += 1e-11;
  const ErrorMatrix x = scaled.ldlt().solve(scale.asDiagonal() * right);
  return scale.asDiagonal() * x;
}

class Smoother {
 public:
  explicit Smoother(const FusionSettings& settings) : filter_(settings) {}

  void add(const FusionInput& input, bool rows_at_fixes) {
    if (const auto* reading = std::get_if<InertialReading>(&input.what)) {
      if (!filter_.take(*reading, input.time, &transition_)) return;
      pass();
      if (const auto attitude = filter_.attitude_due())
        correct(*attitude, input.time);
      else if (!nodes_.empty() && seconds(input.time - nodes_.back().time) >= node_period_s)
        close(filter_.motion(), false);
    } else {
      correct(std::get<Fix>(input.what), input.time);
      if (rows_at_fixes) pass();
    }
  }

  // Smoothed poses up to `overlap_s` before the end, or all of them.
  void give(std::vector<FusedPose>& out, bool all) {
    if (all) close(filter_.motion(), false);
    if (nodes_.empty()) return;
    if (!all && seconds(nodes_.back().time - nodes_.front().time) < piece_s + overlap_s) return;
    const std::vector<MotionState> smoothed = backward();
    std::size_t last = nodes_.size() - 1;
    if (!all)
      while (last > 0 && seconds(nodes_.back().time - nodes_[last].time) < overlap_s) --last;
    for (std::size_t k = 0; k <= last; ++k) write(k, smoothed, out);
    // The last given node stays, as the beginning of the next piece.
    nodes_.erase(nodes_.begin(), nodes_.begin() + static_cast<std::ptrdiff_t>(last));
    nodes_.front().passed.clear();
    nodes_.front().broken = true;
  }

 private:
  void pass() {
    Passed sample{filter_.time(), filter_.state(), filter_.placed(), filter_.motion(), filter_.rate_radps()};
    passed_.push_back(sample);
  }

  void correct(const Fix& fix, Timestamp time) {
    filter_.move_to(time, &transition_);
    const MotionState predicted = filter_.motion();
    const FixResult result = filter_.take(fix, time);
    close(predicted, result.outcome == FixOutcome::anchored);
  }

  void close(const MotionState& predicted, bool broken) {
    nodes_.push_back({filter_.time(), predicted, filter_.motion(), transition_, broken, std::move(passed_)});
    passed_.clear();
    transition_.setIdentity();
  }

  std::vector<MotionState> backward() const {
    std::vector<MotionState> smoothed(nodes_.size());
    smoothed.back() = nodes_.back().corrected;
    for (std::size_t k = nodes_.size() - 1; k-- > 0;) {
      const Node &here = nodes_[k], &next = nodes_[k + 1];
      smoothed[k] = here.corrected;
      if (next.broken) continue;
      const ErrorMatrix& p = here.corrected.covariance;
      const ErrorMatrix gain = solve(next.predicted.covariance, next.transition * p).transpose();
      smoothed[k].add(gain * difference(smoothed[k + 1], next.predicted));
      smoothed[k].covariance =
          p + gain * (smoothed[k + 1].covariance - next.predicted.covariance) * gain.transpose();
    }
    return smoothed;
  }

  // The samples before node k: the errors found at the nodes on both sides, along a line between them.
  void write(std::size_t k, const std::vector<MotionState>& smoothed, std::vector<FusedPose>& out) const {
    const Node& node = nodes_[k];
    if (node.passed.empty()) return;
    const ErrorVector after =
        node.broken ? ErrorVector::Zero().eval() : difference(smoothed[k], node.predicted);
    const bool joined = k > 0 && !node.broken;
    const ErrorVector before = joined ? difference(smoothed[k - 1], nodes_[k - 1].corrected) : after;
    const Timestamp begin = joined ? nodes_[k - 1].time : node.time;
    const double span = seconds(node.time - begin);
    for (const Passed& sample : node.passed) {
      const double share = span > 0 ? std::clamp(seconds(sample.time - begin) / span, 0.0, 1.0) : 1;
      MotionState motion = sample.motion;
      motion.add(before + share * (after - before));
      const MotionState& end = node.broken ? node.predicted : smoothed[k];
      motion.covariance = joined ? ((1 - share) * smoothed[k - 1].covariance + share * end.covariance).eval()
                                 : end.covariance;
      FusedPose pose = pose_of(motion, sample.rate_radps);
      pose.time = sample.time;
      pose.state = sample.state;
      pose.placed = sample.placed;
      out.push_back(pose);
    }
  }

  MotionFilter filter_;
  ErrorMatrix transition_ = ErrorMatrix::Identity();
  std::vector<Node> nodes_;
  std::vector<Passed> passed_;
};

}  // namespace

std::vector<FusedPose> smooth(const std::vector<FusionInput>& inputs, const FusionSettings& settings) {
  const bool inertial = std::any_of(inputs.begin(), inputs.end(), [](const FusionInput& input) {
    return std::holds_alternative<InertialReading>(input.what);
  });
  Smoother smoother(settings);
  std::vector<FusedPose> out;
  for (const FusionInput& input : inputs) {
    smoother.add(input, !inertial);
    smoother.give(out, false);
  }
  smoother.give(out, true);
  return out;
}

std::vector<Eigen::Quaterniond> smooth_orientation(const std::vector<OrientationInput>& inputs,
                                                   const OrientationSettings& settings) {
  std::vector<Eigen::Quaterniond> forward;
  OrientationFilter filter(settings);
  const auto step = [&](std::size_t a, std::size_t b) { return seconds(inputs[b].time - inputs[a].time); };
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    filter.add(inputs[i].reading, i > 0 ? step(i - 1, i) : settings.longest_step_s / 100);
    forward.push_back(filter.earth_from_sensor());
  }
  // A reading is the mean since the one before: backwards its turn belongs to the step that follows.
  filter.reverse();
  std::vector<Eigen::Quaterniond> middle = forward;
  for (std::size_t i = inputs.size(); i-- > 1;) {
    InertialReading reading = inputs[i - 1].reading;
    reading.turn_rate_radps = -inputs[i].reading.turn_rate_radps;
    filter.add(reading, step(i - 1, i));
    const Eigen::Quaterniond mean = forward[i - 1].slerp(0.5, filter.earth_from_sensor());
    const Eigen::Quaterniond moved = mean * forward[i - 1].conjugate();
    const double about_z = 2 * std::atan2(moved.z(), moved.w());
    middle[i - 1] = rotation_of({0, 0, -about_z}) * mean;
  }
  return middle;
}

}  // namespace fude
