#include "capture/import/frame_assembler.h"

#include <linux/input-event-codes.h>

#include <utility>

namespace fude {

Result<void> FrameAssembler::add(Duration time, const EvdevEvent& event, const std::string& where) {
  ++recording_.counts.events;
  frame_.push_back(event);
  const bool report = event.type == EV_SYN && event.code == SYN_REPORT;
  const bool dropped = event.type == EV_SYN && event.code == SYN_DROPPED;
  if (!report && !dropped) return {};

  const Timestamp stamp{time};
  if (!recording_.transfers.empty()) {
    const Timestamp before = recording_.transfers.back().time;
    if (stamp < before)
      return failure(Fault::malformed, where + ": time runs backwards by " +
                                           std::to_string(seconds(before - stamp)) +
                                           " s; cut the file there and import the parts one by one");
    if (stamp == before) ++recording_.counts.still_times;
  }
  if (report) ++recording_.counts.frames;
  recording_.transfers.push_back(
      {stamp, StampedBy::recording, Direction::from_device, TransferKind::evdev_frame, pack_events(frame_)});
  frame_.clear();
  return {};
}

Result<RawRecording> FrameAssembler::finish(std::optional<DeviceDescription> device) && {
  recording_.counts.unclosed_events = frame_.size();
  const std::size_t frames = recording_.transfers.size();
  if (frames >= 3 && recording_.counts.still_times == frames - 1)
    return failure(Fault::malformed, "all " + std::to_string(frames) +
                                         " frames carry the same time; record again with time stamps");
  recording_.device = std::move(device);
  return std::move(recording_);
}

}  // namespace fude
