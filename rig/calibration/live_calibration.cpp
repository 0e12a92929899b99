#include "rig/calibration/live_calibration.h"

#include <utility>

#include "rig/attached_devices.h"
#include "rig/session_identity.h"

namespace fude {

Result<std::unique_ptr<LiveCalibration>> LiveCalibration::start(
    Calibrator& calibrator, LiveWish wish, std::function<void(const std::string&)> warn) {
  std::unique_ptr<LiveCalibration> live(new LiveCalibration(calibrator));
  DeviceListener listener;
  listener.appeared = [raw = live.get()](std::size_t device, const DeviceDescription& description) {
    raw->hearing_.begin(device, description);
  };
  listener.heard = [raw = live.get()](std::size_t device, const Transfer& transfer,
                                      std::span<const Sample> samples) {
    raw->hearing_.hear(device, transfer, samples);
  };
  if (wish.session) {
    live->session_ = wish.session;
    auto recording = RecordingSession::start(*wish.session,
                                             {.overwrite = wish.overwrite,
                                              .named = std::move(wish.named),
                                              .calibrations = std::move(wish.calibrations),
                                              .also = std::move(listener)},
                                             std::move(warn));
    if (!recording) return tl::unexpected(recording.error());
    live->recording_ = std::move(*recording);
    return live;
  }
  if (wish.named.empty())
    if (auto there = something_attached(); !there) return tl::unexpected(there.error());
  listener.refused = [warn = std::move(warn)](const Error& error) { warn(error.message); };
  auto devices = Devices::open(std::move(listener), {.named = std::move(wish.named)});
  if (!devices) return tl::unexpected(devices.error());
  live->devices_ = std::move(*devices);
  return live;
}

Result<CalibrationOutcome> LiveCalibration::finish() {
  if (devices_) devices_->stop();
  if (recording_)
    if (const auto closed = recording_->finish(); !closed) return tl::unexpected(closed.error());
  auto outcome = hearing_.finish();
  if (!outcome || !session_) return outcome;
  const auto session = read_session(*session_);
  if (!session) return tl::unexpected(session.error());
  outcome->report.session = session_identity(*session);
  return outcome;
}

}  // namespace fude
