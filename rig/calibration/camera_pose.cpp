#include "rig/calibration/camera_pose.h"

#include <cmath>
#include <optional>
#include <utility>

#include "calibration/pose_fields.h"
#include "rig/calibration/camera.h"
#include "rig/calibration/shown_pictures.h"
#include "vision/camera_pose.h"

namespace fude {
namespace {

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

// The corners put the board wrong as a whole, beside what the picture does.
void add_place(CalibrationReport& report, const BoardPlace& board) {
  if (!board.by_corners) return;
  report.detail("board_corners_rms_mm", board.by_corners->rms);
  report.detail("board_ci95_mm", board.radius95_mm);
  const auto& warnings = board.by_corners->warnings;
  for (const std::string& warning : warnings) report.warnings.push_back("the board's corners: " + warning);
  if (report.ci95) (*report.ci95)[1] = std::hypot((*report.ci95)[1], board.radius95_mm);
  constexpr double widest_mm = 2;  // as of the picture alone
  if (!report.accepted) return;
  report.reason = "places on the paper under the board are known to within " + in_words((*report.ci95)[1]) +
                  " mm (95 %), " + in_words(board.radius95_mm) + " mm of it by its corners";
  if ((*report.ci95)[1] < widest_mm) return;
  report.accepted = false;
  report.reason += ": touch the four corners more carefully, and with a tip that was calibrated well";
}

class CameraPoseCalibrator final : public Calibrator {
 public:
  CameraPoseCalibrator(const CameraPoseWish& wish, BoardPlace place, KnownCalibrations known)
      : board_(wish.board), place_(std::move(place)), known_(std::move(known)), pictures_(wish.camera) {}

  void begin(DeviceNumber device, const DeviceDescription& description) override {
    pictures_.begin(device, description);
  }

  Result<Progress> hear(DeviceNumber device, const Sample& sample, const Transfer* picture) override {
    const auto shown = pictures_.hear(device, sample, picture);
    if (!shown) return tl::unexpected(shown.error());
    if (!procedure_ && pictures_.camera())
      if (const auto ready = take_lens(); !ready) return tl::unexpected(ready.error());
    if (*shown) {
      const auto progress = procedure_->add((*shown)->image, (*shown)->name);
      progress_ = {progress.pictures, progress.missing.empty() ? 1.0 : 0.0, progress.missing};
    }
    return progress_;
  }

  Result<CalibrationOutcome> finish() override {
    if (const auto camera = pictures_.found(); !camera) return tl::unexpected(camera.error());
    const CameraPlacement found = procedure_->finish();
    CalibrationOutcome outcome{report_of(found), std::nullopt};
    add_place(outcome.report, place_);
    pictures_.sign(outcome.report);
    if (!outcome.report.accepted) return outcome;
    outcome.result.emplace();
    put_pose(*outcome.result, "paper_from_camera", found.paper_from_camera);
    return outcome;
  }

 private:
  Result<void> take_lens() {
    const auto known = known_.find("camera", *pictures_.camera());
    if (!known) return tl::unexpected(known.error());
    const auto lens = *known ? camera_from((*known)->result) : std::nullopt;
    if (!lens)
      return failure(
          Fault::usage,
          "camera-pose needs the camera's lens: fude calibrate camera first, and give --cal CAMERA.toml");
    auto procedure = CameraPoseProcedure::begin(board_, *lens, place_.paper_from_board);
    if (!procedure) return tl::unexpected(procedure.error());
    procedure_.emplace(std::move(*procedure));
    return {};
  }

  Board board_;
  BoardPlace place_;
  KnownCalibrations known_;
  ShownPictures pictures_;
  std::optional<CameraPoseProcedure> procedure_;  // from the first frame on, when the lens is known
  Progress progress_;
};

}  // namespace

Result<std::unique_ptr<Calibrator>> camera_pose_calibrator(const CameraPoseWish& wish,
                                                           KnownCalibrations known) {
  if (const auto possible = CameraPoseProcedure::begin(wish.board, {}, {}); !possible)
    return tl::unexpected(possible.error());
  auto place = place_of(wish.board, wish.at, known);
  if (!place) return tl::unexpected(place.error());
  return std::make_unique<CameraPoseCalibrator>(wish, std::move(*place), std::move(known));
}

}  // namespace fude
