#include "rig/calibration/tip_touches.h"

#include <utility>

namespace fude {

Result<void> TipTouches::add(const Result<std::vector<PoseSample>>& poses) {
  if (!poses) return tl::unexpected(poses.error());
  if (!tip_m_ && poses_.tool()) {
    const auto tip = tip_of(procedure_, std::nullopt, known_, *poses_.tool());
    if (!tip) return tl::unexpected(tip.error());
    tip_m_ = *tip;
  }
  for (const PoseSample& pose : *poses) {
    if (!pose.valid) continue;
    way_.push_back({pose.time.host, pose.tracker_from_tool * *tip_m_, way_.size()});
    turned_.push_back(pose.tracker_from_tool.rotation);
  }
  return {};
}

Progress TipTouches::towards(const std::vector<Landmark>& listed) {
  constexpr std::size_t between_looks = 256;
  if (way_.size() >= looked_ + between_looks) {
    looked_ = way_.size();
    rested_ = resting_places(way_).size();
  }
  if (rested_ >= listed.size()) return {way_.size(), 1, {}};
  return {way_.size(), double(rested_) / double(listed.size()), "touch " + listed[rested_].name};
}

std::vector<TipTouches::Touch> TipTouches::touches(std::size_t count) const {
  std::vector<Touch> touched;
  for (const TipPoint& touch : way_.size() == count ? way_ : resting_places(way_)) {
    const Eigen::Quaterniond& rotation = turned_[touch.number];
    touched.push_back({touch.point_m, {rotation, touch.point_m - rotation * *tip_m_}});
  }
  return touched;
}

}  // namespace fude
