#include "rig/calibration/distortion.h"

#include <utility>
#include <variant>
#include <vector>

#include "calibration/distortion.h"
#include "rig/calibration/landmark_file.h"
#include "rig/calibration/tip_touches.h"
#include "rig/calibration/two_tools.h"

namespace fude {
namespace {

Calibration<DistortionField> mapped(const std::vector<MappedPlace>& places) {
  DistortionProcedure procedure;
  for (const MappedPlace& place : places) procedure.add(place);
  return procedure.finish();
}

// Of what both trackers saw, as a procedure.
class MapByMotion {
 public:
  Progress add(const PoseSample& magnetic) {
    magnetic_.push_back(magnetic);
    return progress();
  }
  Progress add_other(const PoseSample& undisturbed) {
    undisturbed_.push_back(undisturbed);
    return progress();
  }
  Calibration<DistortionField> finish() const { return mapped(places_of_motion(magnetic_, undisturbed_)); }

 private:
  static constexpr std::size_t enough_poses = 2000;
  Progress progress() const {
    const std::size_t both = std::min(magnetic_.size(), undisturbed_.size());
    const double share = std::min(1.0, double(both) / double(enough_poses));
    return {both, share, share < 1 ? "move through the whole volume, turning it" : ""};
  }

  std::vector<PoseSample> magnetic_, undisturbed_;
};

class MappedByGrid final : public Calibrator {
 public:
  MappedByGrid(DistortionWish wish, KnownCalibrations known, std::vector<Landmark> grid)
      : grid_(std::move(grid)), touches_("distortion", {{wish.tool, {}}, wish.tip_m}, std::move(known)) {}

  void begin(DeviceNumber device, const DeviceDescription& description) override {
    touches_.begin(device, description);
  }

  Result<Progress> hear(DeviceNumber device, const Sample& sample, const Transfer*) override {
    return touches_.hear(device, sample).map([this] { return touches_.towards(grid_); });
  }

  Result<CalibrationOutcome> finish() override {
    if (const auto ended = touches_.end(); !ended) return tl::unexpected(ended.error());
    auto outcome = found();
    touches_.poses().sign_frame(outcome.report);
    return outcome;
  }

 private:
  CalibrationOutcome found() const {
    std::vector<Pose<Tracker, Tool>> touched;
    for (const TipTouches::Touch& touch : touches_.touches(grid_.size()))
      touched.push_back(touch.tracker_from_tool);
    if (touched.size() == grid_.size())
      return outcome_of(mapped(places_of_grid(touched, *touches_.tip_m(), grid_)));
    CalibrationOutcome outcome;
    outcome.report.procedure = "distortion";
    outcome.report.n = touched.size();
    outcome.report.reason = std::to_string(touched.size()) + " points were touched, but " +
                            std::to_string(grid_.size()) + " are listed";
    return outcome;
  }

  std::vector<Landmark> grid_;
  TipTouches touches_;
};

}  // namespace

Result<std::unique_ptr<Calibrator>> distortion_calibrator(DistortionWish wish, KnownCalibrations known) {
  if (wish.other.empty() == !wish.grid)
    return failure(Fault::usage,
                   "distortion needs the truth: give --other TOOL, of a tracker that no iron disturbs, or "
                   "--landmarks FILE, the points of a grid");
  if (!wish.grid)
    return std::make_unique<TwoToolCalibrator<MapByMotion>>(TwoTools(wish.tool, wish.other),
                                                            &TwoTools::sign_tracker);
  auto grid = read_landmarks(*wish.grid);
  if (!grid) return tl::unexpected(grid.error());
  return std::make_unique<MappedByGrid>(std::move(wish), std::move(known), std::move(*grid));
}

}  // namespace fude
