#include "rig/calibration/session_inputs.h"

#include <map>
#include <tuple>
#include <variant>

#include "capture/recorded_pictures.h"
#include "capture/sample_columns.h"

namespace fude {
namespace {

// Sessions that were never in a file have no order: their times stand for it.
bool before(const RecordedPen& pen, const RecordedSample& sample) {
  return std::tuple(pen.order, pen.sample.time.host) < std::tuple(sample.order, time_of(sample.sample).host);
}

}  // namespace

Result<void> for_each_input(const Session& session, const HearInput& hear) {
  std::map<DeviceNumber, RecordedPictures> cameras;
  const auto picture_of = [&](const RecordedSample& recorded) -> const Transfer* {
    const auto* frame = std::get_if<CameraFrame>(&recorded.sample);
    if (frame == nullptr) return nullptr;
    return cameras.try_emplace(recorded.device, session, recorded.device).first->second.of(*frame);
  };
  auto pen = session.pens.begin();
  auto sample = session.samples.begin();
  while (pen != session.pens.end() || sample != session.samples.end()) {
    Result<void> heard;
    if (sample == session.samples.end() || (pen != session.pens.end() && before(*pen, *sample))) {
      heard = hear(pen->device, pen->sample, nullptr);
      ++pen;
    } else {
      heard = hear(sample->device, sample->sample, picture_of(*sample));
      ++sample;
    }
    if (!heard) return heard;
  }
  return {};
}

}  // namespace fude
