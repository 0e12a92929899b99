#include "rig/calibration/camera.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "rig/calibration/shown_pictures.h"
#include "vision/camera_calibration.h"

namespace fude {
namespace {

std::vector<double> list_of(const Eigen::Vector2d& pair) { return {pair.x(), pair.y()}; }

Fields fields_of(const CameraCalibration& found) {
  const CameraModel& camera = found.camera;
  return {{"width_px", static_cast<double>(camera.width)},
          {"height_px", static_cast<double>(camera.height)},
          {"focal_px", list_of(camera.focal_px)},
          {"centre_px", list_of(camera.centre_px)},
          {"distortion", std::vector<double>(camera.distortion.begin(), camera.distortion.end())},
          {"focal_deviation_px", list_of(found.focal_deviation_px)},
          {"centre_deviation_px", list_of(found.centre_deviation_px)}};
}

CalibrationReport report_of(const CameraCalibration& found) {
  CalibrationReport report;
  report.procedure = "camera";
  report.to_frame = "picture";
  report.from_frame = "camera";
  report.unit = "px";
  summarise(report, found.residuals_px, 2);
  if (!found.residuals_px.empty()) {
    report.held_out_rms = found.held_out_rms_px;
    constexpr double of_95 = 1.96;
    const double focal = found.camera.focal_px.x();
    const double deviation = found.focal_deviation_px.x();
    report.ci95 = {focal - of_95 * deviation, focal + of_95 * deviation};
  }
  report.accepted = found.accepted;
  report.reason = found.reason;
  report.warnings = found.warnings;
  std::vector<std::string> names, left_out;
  std::vector<double> rms;
  for (const FittedView& view : found.views) {
    names.push_back(view.name);
    rms.push_back(view.rms_px);
    if (!view.used) left_out.push_back(view.name);
  }
  report.detail("views", names);
  report.detail("view_rms_px", rms);
  report.detail("views_left_out", left_out);
  report.detail("pictures_without_board", found.boardless);
  report.detail("views_alike", static_cast<double>(found.alike));
  report.detail("coverage", found.coverage);
  report.detail("coverage_map", found.coverage_map);
  report.detail("largest_tilt_rad", found.tilt_rad);
  return report;
}

class CameraCalibrator final : public Calibrator {
 public:
  CameraCalibrator(const std::string& camera, CameraProcedure procedure)
      : pictures_(camera), procedure_(std::move(procedure)) {}

  void begin(DeviceNumber device, const DeviceDescription& description) override {
    pictures_.begin(device, description);
  }

  Result<Progress> hear(DeviceNumber device, const Sample& sample, const Transfer* picture) override {
    const auto shown = pictures_.hear(device, sample, picture);
    if (!shown) return tl::unexpected(shown.error());
    if (*shown) {
      const CameraProcedure::Progress progress = procedure_.add((*shown)->image, (*shown)->name);
      progress_ = {progress.views, progress.covered, progress.missing};
    }
    return progress_;
  }

  Result<CalibrationOutcome> finish() override {
    if (const auto camera = pictures_.found(); !camera) return tl::unexpected(camera.error());
    const CameraCalibration found = procedure_.finish();
    CalibrationOutcome outcome{report_of(found), std::nullopt};
    pictures_.sign(outcome.report);
    if (found.accepted) outcome.result = fields_of(found);
    return outcome;
  }

 private:
  ShownPictures pictures_;
  CameraProcedure procedure_;
  Progress progress_;
};

}  // namespace

std::optional<CameraModel> camera_from(const Fields& fields) {
  const auto list = [&](std::string_view key, std::size_t count) {
    auto numbers = numbers_in(fields, key).value_or(std::vector<double>{});
    const bool whole =
        numbers.size() == count && std::ranges::all_of(numbers, [](double v) { return std::isfinite(v); });
    return whole ? std::optional(std::move(numbers)) : std::nullopt;
  };
  const auto width = list("width_px", 1), height = list("height_px", 1), focal = list("focal_px", 2),
             centre = list("centre_px", 2), distortion = list("distortion", 5);
  constexpr double largest_px = 1e5;
  if (!width || !height || !focal || !centre || !distortion || !(width->front() > 0) ||
      !(height->front() > 0) || !(width->front() < largest_px) || !(height->front() < largest_px) ||
      !((*focal)[0] > 0) || !((*focal)[1] > 0))
    return std::nullopt;
  CameraModel camera;
  camera.width = static_cast<std::int32_t>(width->front());
  camera.height = static_cast<std::int32_t>(height->front());
  camera.focal_px = {(*focal)[0], (*focal)[1]};
  camera.centre_px = {(*centre)[0], (*centre)[1]};
  std::ranges::copy(*distortion, camera.distortion.begin());
  return camera;
}

Result<std::unique_ptr<Calibrator>> camera_calibrator(const CameraWish& wish) {
  auto procedure = CameraProcedure::begin(wish.board);
  if (!procedure) return tl::unexpected(procedure.error());
  return std::make_unique<CameraCalibrator>(wish.camera, std::move(*procedure));
}

}  // namespace fude
