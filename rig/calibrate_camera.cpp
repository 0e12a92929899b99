#include "rig/calibrate_camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <variant>
#include <vector>

#include "capture/picture/grey_picture.h"
#include "capture/recorded_pictures.h"
#include "vision/camera_calibration.h"

namespace fude {
namespace {

Result<DeviceNumber> find_camera(const Session& session, const std::string& name) {
  std::vector<const RecordedDevice*> cameras;
  for (const RecordedDevice& device : session.devices)
    if (device.description.kind == DeviceKind::camera && (name.empty() || device.description.name == name))
      cameras.push_back(&device);
  if (cameras.empty())
    return failure(Fault::not_found, name.empty() ? "the session has no pictures of a camera"
                                                  : "the session has no camera '" + name + "'");
  if (cameras.size() > 1)
    return failure(Fault::usage, "the session has several cameras; name one with --tool '" +
                                     cameras.front()->description.name + "'");
  return cameras.front()->number;
}

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

}  // namespace

Result<CalibrationOutcome> calibrate_camera(const Session& session, const std::string& camera,
                                            const Board& board, const OnProgress& on_progress) {
  const auto number = find_camera(session, camera);
  if (!number) return tl::unexpected(number.error());
  auto procedure = CameraProcedure::begin(board);
  if (!procedure) return tl::unexpected(procedure.error());
  RecordedPictures pictures(session, *number);
  std::size_t count = 0;
  std::vector<std::string> damaged;
  for (const RecordedSample& recorded : session.samples) {
    const auto* frame = std::get_if<CameraFrame>(&recorded.sample);
    if (recorded.device != *number || frame == nullptr) continue;
    const std::string name = "picture " + std::to_string(++count);
    const Transfer* picture = pictures.of(*frame);
    const auto image = picture ? grey_picture(picture->payload, *frame)
                               : Result<GreyImage>(failure(Fault::not_found, "its bytes are not there"));
    if (!image) {
      damaged.push_back(name + " is left out: " + image.error().message);
      continue;
    }
    const CameraProcedure::Progress progress = procedure->add(*image, name);
    if (on_progress) on_progress({progress.views, progress.covered, progress.missing});
  }
  const CameraCalibration found = procedure->finish();
  CalibrationOutcome outcome{report_of(found), std::nullopt};
  outcome.report.warnings.insert(outcome.report.warnings.end(), damaged.begin(), damaged.end());
  if (found.accepted) outcome.result = fields_of(found);
  return outcome;
}

}  // namespace fude
