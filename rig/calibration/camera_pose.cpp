#include "rig/calibration/camera_pose.h"

#include <numbers>
#include <optional>
#include <utility>
#include <variant>

#include "calibration/pose_fields.h"
#include "rig/calibration/camera.h"
#include "rig/calibration/shown_pictures.h"
#include "rig/calibration/stream_choice.h"
#include "vision/camera_pose.h"

namespace fude {
namespace {

Pose<Paper, BoardFrame> place_of(const LyingAt& at) {
  return lying_at(1e-3 * at.x_mm, 1e-3 * at.y_mm, at.turn_deg * std::numbers::pi / 180);
}

CalibrationReport report_of(const CameraPlacement& found) {
  CalibrationReport report;
  report.procedure = "camera-pose";
  report.to_frame = "paper";
  report.from_frame = "camera";
  summarise(report, found.residuals_mm, 2);
  if (!found.residuals_mm.empty()) {
    report.held_out_rms = found.held_out_rms_mm;
    report.ci95 = {0, found.radius95_mm};
    report.condition = found.condition;
  }
  report.accepted = found.accepted;
  report.reason = found.reason;
  report.warnings = found.warnings;
  report.detail("reprojection_rms_px", found.rms_px);
  report.detail("camera_ci95_mm", 1e3 * found.camera_radius95_m);
  report.detail("share_of_picture", found.share_of_picture);
  report.detail("pictures", double(found.pictures));
  report.detail("pictures_without_board", found.boardless);
  report.detail("pictures_elsewhere", found.moved);
  report.detail("corners_left_out", double(found.corners_left_out));
  return report;
}

class CameraPoseCalibrator final : public Calibrator {
 public:
  CameraPoseCalibrator(CameraPoseWish wish, KnownCalibrations known)
      : wish_(std::move(wish)),
        known_(std::move(known)),
        camera_({.name = wish_.camera, .what = "camera", .kinds = is_kind<CameraFrame>}) {}

  void begin(DeviceNumber device, const DeviceDescription& description) override {
    camera_.begin(device, description);
  }

  Result<Progress> hear(DeviceNumber device, const Sample& sample, const Transfer* picture) override {
    const auto mine = camera_.takes(device, sample);
    if (!mine) return tl::unexpected(mine.error());
    if (!*mine) return progress_;
    if (!procedure_)
      if (const auto ready = take_lens(); !ready) return tl::unexpected(ready.error());
    if (const auto shown = pictures_.next(std::get<CameraFrame>(sample), picture)) {
      const auto progress = procedure_->add(shown->image, shown->name);
      progress_ = {progress.pictures, progress.missing.empty() ? 1.0 : 0.0, progress.missing};
    }
    return progress_;
  }

  Result<CalibrationOutcome> finish() override {
    const auto camera = camera_.found();
    if (!camera) return tl::unexpected(camera.error());
    const CameraPlacement found = procedure_->finish();
    CalibrationOutcome outcome{report_of(found), std::nullopt};
    outcome.report.devices = {camera->device.id};
    const auto& damaged = pictures_.damaged();
    outcome.report.warnings.insert(outcome.report.warnings.end(), damaged.begin(), damaged.end());
    if (!found.accepted) return outcome;
    outcome.result.emplace();
    put_pose(*outcome.result, "paper_from_camera", found.paper_from_camera);
    return outcome;
  }

 private:
  Result<void> take_lens() {
    const auto known = known_.find("camera", *camera_.chosen());
    if (!known) return tl::unexpected(known.error());
    const auto lens = *known ? camera_from((*known)->result) : std::nullopt;
    if (!lens)
      return failure(
          Fault::usage,
          "camera-pose needs the camera's lens: fude calibrate camera first, and give --cal CAMERA.toml");
    auto procedure = CameraPoseProcedure::begin(wish_.board, *lens, place_of(wish_.lying_at));
    if (!procedure) return tl::unexpected(procedure.error());
    procedure_.emplace(std::move(*procedure));
    return {};
  }

  CameraPoseWish wish_;
  KnownCalibrations known_;
  StreamChoice camera_;
  ShownPictures pictures_;
  std::optional<CameraPoseProcedure> procedure_;  // from the first frame on, when the lens is known
  Progress progress_;
};

}  // namespace

Result<std::unique_ptr<Calibrator>> camera_pose_calibrator(const CameraPoseWish& wish,
                                                           KnownCalibrations known) {
  if (const auto possible = CameraPoseProcedure::begin(wish.board, {}, place_of(wish.lying_at)); !possible)
    return tl::unexpected(possible.error());
  return std::make_unique<CameraPoseCalibrator>(wish, std::move(known));
}

}  // namespace fude
