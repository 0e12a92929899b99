#include "calibration/pose_screen.h"

#include <cmath>

namespace fude {

PoseScreen::Finding PoseScreen::look(const PoseSample& sample) {
  ++seen_;
  const Pose<Tracker, Tool>& pose = sample.tracker_from_tool;
  const bool sound = sample.valid && pose.translation.allFinite() && pose.rotation.coeffs().allFinite() &&
                     std::abs(pose.rotation.norm() - 1) < 1e-3;
  if (!sound) {
    ++unusable_;
    return Finding::unusable;
  }
  if (last_ && sample.time.host < last_->time.host) ++backwards_;
  const bool repeat = last_ && last_->tracker_from_tool.translation == pose.translation &&
                      last_->tracker_from_tool.rotation.coeffs() == pose.rotation.coeffs();
  last_ = sample;
  if (repeat) ++repeats_;
  return repeat ? Finding::repeat : Finding::sound;
}

void PoseScreen::warn(CalibrationReport& report) const {
  const auto of_all = [&](std::size_t count) {
    return std::to_string(count) + " of " + std::to_string(seen_) + " poses";
  };
  if (unusable_ > 0)
    report.warnings.push_back(of_all(unusable_) + " were left out: not seen by the tracker, or no numbers");
  if (repeats_ > 0)
    report.warnings.push_back(of_all(repeats_) + " repeat the one before to the last bit and count once");
  if (backwards_ > 0)
    report.warnings.push_back("time went backwards " + std::to_string(backwards_) +
                              " times: a clock started again");
}

}  // namespace fude
