#include "rig/calibration/distortion.h"

#include <utility>
#include <variant>
#include <vector>

#include "calibration/distortion.h"
#include "calibration/touches.h"
#include "rig/calibration/tool_poses.h"
#include "rig/calibration/two_tools.h"
#include "rig/landmark_file.h"

namespace fude {
namespace {

CalibrationOutcome mapped(const std::vector<MappedPlace>& places) {
  DistortionProcedure procedure;
  for (const MappedPlace& place : places) procedure.add(place);
  return outcome_of(procedure.finish());
}

class MappedByMotion final : public Calibrator {
 public:
  explicit MappedByMotion(const DistortionWish& wish) : tools_(wish.tool, wish.other) {}

  void begin(DeviceNumber device, const DeviceDescription& description) override {
    tools_.begin(device, description);
  }

  Result<Progress> hear(DeviceNumber device, const Sample& sample, const Transfer*) override {
    const auto heard = tools_.hear(device, sample);
    if (!heard) return tl::unexpected(heard.error());
    if (heard->of_tool) magnetic_.push_back(*heard->of_tool);
    if (heard->of_other) undisturbed_.push_back(*heard->of_other);
    const std::size_t both = std::min(magnetic_.size(), undisturbed_.size());
    const double share = std::min(1.0, double(both) / double(enough_poses));
    return Progress{both, share, share < 1 ? "move through the whole volume, turning it" : ""};
  }

  Result<CalibrationOutcome> finish() override {
    if (const auto found = tools_.found(); !found) return tl::unexpected(found.error());
    auto outcome = mapped(places_of_motion(magnetic_, undisturbed_));
    tools_.sign_tracker(outcome.report);
    return outcome;
  }

 private:
  static constexpr std::size_t enough_poses = 2000;

  TwoTools tools_;
  std::vector<PoseSample> magnetic_, undisturbed_;
};

class MappedByGrid final : public Calibrator {
 public:
  MappedByGrid(DistortionWish wish, KnownCalibrations known, std::vector<Landmark> grid)
      : wish_(std::move(wish)), known_(std::move(known)), grid_(std::move(grid)), poses_({wish_.tool, {}}) {}

  void begin(DeviceNumber device, const DeviceDescription& description) override {
    poses_.begin(device, description);
  }

  Result<Progress> hear(DeviceNumber device, const Sample& sample, const Transfer*) override {
    const auto poses = poses_.hear(device, sample);
    if (!poses) return tl::unexpected(poses.error());
    if (!tip_m_ && poses_.tool()) {
      const auto tip = tip_of("distortion", wish_.tip_m, known_, *poses_.tool());
      if (!tip) return tl::unexpected(tip.error());
      tip_m_ = *tip;
    }
    for (const PoseSample& pose : *poses) {
      if (!pose.valid) continue;
      way_.push_back({pose.time.host, pose.tracker_from_tool * *tip_m_, way_.size()});
      seen_.push_back(pose.tracker_from_tool);
    }
    if (way_.size() >= looked_ + between_looks) {
      looked_ = way_.size();
      touches_ = resting_places(way_).size();
    }
    if (touches_ >= grid_.size()) return Progress{way_.size(), 1, {}};
    return Progress{way_.size(), double(touches_) / double(grid_.size()), "touch " + grid_[touches_].name};
  }

  Result<CalibrationOutcome> finish() override {
    if (const auto last = poses_.rest(); !last) return tl::unexpected(last.error());
    const auto touches = way_.size() == grid_.size() ? way_ : resting_places(way_);
    if (touches.size() != grid_.size()) {
      CalibrationOutcome outcome;
      outcome.report.procedure = "distortion";
      outcome.report.n = touches.size();
      outcome.report.reason = std::to_string(touches.size()) + " points were touched, but " +
                              std::to_string(grid_.size()) + " are listed";
      poses_.sign_frame(outcome.report);
      return outcome;
    }
    std::vector<Pose<Tracker, Tool>> touched;
    for (const TipPoint& touch : touches) {
      const Eigen::Quaterniond& rotation = seen_[touch.number].rotation;
      touched.push_back({rotation, touch.point_m - rotation * *tip_m_});
    }
    auto outcome = mapped(places_of_grid(touched, *tip_m_, grid_));
    poses_.sign_frame(outcome.report);
    return outcome;
  }

 private:
  static constexpr std::size_t between_looks = 256;

  DistortionWish wish_;
  KnownCalibrations known_;
  std::vector<Landmark> grid_;
  ToolPoses poses_;
  std::optional<Eigen::Vector3d> tip_m_;
  std::vector<TipPoint> way_;
  std::vector<Pose<Tracker, Tool>> seen_;  // as many
  std::size_t looked_ = 0, touches_ = 0;
};

}  // namespace

Result<std::unique_ptr<Calibrator>> distortion_calibrator(DistortionWish wish, KnownCalibrations known) {
  if (wish.other.empty() == !wish.grid)
    return failure(Fault::usage,
                   "distortion needs the truth: give --other TOOL, of a tracker that no iron disturbs, or "
                   "--landmarks FILE, the points of a grid");
  if (!wish.grid) return std::make_unique<MappedByMotion>(wish);
  auto grid = read_landmarks(*wish.grid);
  if (!grid) return tl::unexpected(grid.error());
  return std::make_unique<MappedByGrid>(std::move(wish), std::move(known), std::move(*grid));
}

}  // namespace fude
