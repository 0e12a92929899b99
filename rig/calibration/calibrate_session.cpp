#include "rig/calibration/calibrate_session.h"

#include <chrono>
#include <ctime>
#include <string>

#include "rig/calibration/session_inputs.h"
#include "rig/session_identity.h"

namespace fude {
namespace {

std::string now_utc() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm parts{};
  gmtime_r(&now, &parts);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text;
}

}  // namespace

Result<CalibrationOutcome> finish_today(Calibrator& calibrator) {
  auto outcome = calibrator.finish();
  if (outcome) outcome->report.date = now_utc();
  return outcome;
}

Result<CalibrationOutcome> calibrate_session(Calibrator& calibrator, const Session& session,
                                             const OnProgress& on_progress) {
  for (const RecordedDevice& device : session.devices) calibrator.begin(device.number, device.description);
  constexpr std::size_t between_reports = 256;
  std::size_t count = 0;
  const auto heard = for_each_input(
      session, [&](DeviceNumber device, const Sample& sample, const Transfer* picture) -> Result<void> {
        const auto progress = calibrator.hear(device, sample, picture);
        if (!progress) return tl::unexpected(progress.error());
        if (on_progress && (picture || ++count % between_reports == 0)) on_progress(*progress);
        return {};
      });
  if (!heard) return tl::unexpected(heard.error());
  auto outcome = finish_today(calibrator);
  if (outcome && !session.devices.empty()) outcome->report.session = session_identity(session);
  return outcome;
}

}  // namespace fude
