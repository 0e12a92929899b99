#include "rig/record_session.h"

#include <algorithm>
#include <utility>

#include "drivers/transport/device_node.h"

namespace fude {

Result<std::unique_ptr<RecordingSession>> RecordingSession::start(
    const std::filesystem::path& session, bool overwrite, std::function<void(const std::string&)> warn) {
  // Before the file is made: a session of nothing helps nobody.
  const auto found = find_pen_tablets();
  if (!found) return tl::unexpected(found.error());
  if (found->empty())
    return failure(Fault::not_found, "no pen tablet is plugged in; plug one in and try again");
  if (std::none_of(found->begin(), found->end(), [](const FoundDevice& device) { return device.access; }))
    return failure(Fault::no_access, access_advice(found->front().node));

  std::error_code ignored;
  if (overwrite && std::filesystem::is_regular_file(session, ignored))
    std::filesystem::remove(session, ignored);
  auto recorder = Recorder::open(session);
  if (!recorder) return tl::unexpected(recorder.error());
  std::unique_ptr<RecordingSession> recording(new RecordingSession(std::move(*recorder)));
  RecordingSession* raw = recording.get();
  TabletListener listener;
  // The recorder numbers devices from 1 in the order in which they are added, tablets from 0.
  const auto number = [](std::size_t tablet) { return static_cast<DeviceNumber>(tablet) + 1; };
  listener.appeared = [raw](std::size_t, const DeviceDescription& device) {
    raw->names_.push_back(device.name);
    raw->recorder_->add(device);
  };
  listener.heard = [raw, number](std::size_t tablet, const Transfer& transfer,
                                 const std::optional<PenSample>& sample) {
    raw->recorder_->add(RecordedTransfer{number(tablet), transfer});
    if (sample) raw->recorder_->add(RecordedPen{0, number(tablet), *sample, std::nullopt});
  };
  listener.refused = [warn](const Error& error) { warn(error.message); };
  auto tablets = Tablets::open(std::move(listener));
  if (!tablets) return tl::unexpected(tablets.error());
  recording->tablets_ = std::move(*tablets);
  return recording;
}

Result<std::vector<RecordedStream>> RecordingSession::finish() {
  tablets_->stop();
  std::vector<RecordedStream> streams;
  const std::vector<DecodeCounts> counts = tablets_->counts();
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const auto dropped = static_cast<std::int64_t>(counts[i].lost);
    const auto received = static_cast<std::int64_t>(counts[i].frames);
    // A stale frame after a drop is counted among the frames and among the lost.
    streams.push_back({names_[i], received, received - dropped, dropped});
    recorder_->add(Receipt{static_cast<DeviceNumber>(i) + 1, received, received - dropped, dropped});
  }
  if (auto closed = recorder_->close(); !closed) return tl::unexpected(closed.error());
  return streams;
}

}  // namespace fude
