#include "rig/record_session.h"

#include <algorithm>
#include <utility>

#include "capture/sample_columns.h"
#include "drivers/transport/waker.h"
#include "rig/camera_report.h"

namespace fude {
namespace {

// The recorder numbers devices from 1 in the order in which they are added, the rig from 0.
DeviceNumber number(std::size_t device) { return static_cast<DeviceNumber>(device) + 1; }

}  // namespace

Result<std::unique_ptr<RecordingSession>> RecordingSession::start(
    const std::filesystem::path& session, RecordingWish wish, std::function<void(const std::string&)> warn) {
  // Before the file is made: a session of nothing helps nobody.
  if (wish.named.empty())
    if (auto there = something_attached(); !there) return tl::unexpected(there.error());

  std::error_code ignored;
  if (wish.overwrite && std::filesystem::is_regular_file(session, ignored))
    std::filesystem::remove(session, ignored);
  auto recorder = Recorder::open(session);
  if (!recorder) return tl::unexpected(recorder.error());
  std::unique_ptr<RecordingSession> recording(new RecordingSession(std::move(*recorder), wish));
  RecordingSession* raw = recording.get();
  DeviceListener listener;
  listener.appeared = [raw](std::size_t number, const DeviceDescription& device) {
    raw->begin(device);
    if (raw->also_.appeared) raw->also_.appeared(number, device);
  };
  listener.heard = [raw](std::size_t device, const Transfer& transfer, std::span<const Sample> samples) {
    raw->keep(device, transfer, samples);
    if (raw->also_.heard) raw->also_.heard(device, transfer, samples);
  };
  listener.refused = [warn](const Error& error) { warn(error.message); };
  listener.camera = [raw, warn, asked = wish.camera](std::size_t device, const CameraSettings& given) {
    raw->recorder_->add(SessionSetting{"camera_" + std::to_string(number(device)), camera_record(given)});
    if (const std::string remark = camera_remark(asked, given); !remark.empty())
      warn(raw->name_of(device) + ": " + remark);
  };
  auto devices = Devices::open(std::move(listener),
                               {.named = std::move(wish.named), .camera = wish.camera, .sleep = wish.sleep});
  if (!devices) return tl::unexpected(devices.error());
  recording->devices_ = std::move(*devices);
  return recording;
}

void RecordingSession::begin(const DeviceDescription& device) {
  recorder_->add(device);
  for (RecordedCalibration& calibration : passport_.begin(device)) recorder_->add(std::move(calibration));
  const std::lock_guard lock(mutex_);
  const auto same = std::ranges::count_if(streams_, [&](const auto& s) {
    return s->name == device.name || s->name.starts_with(device.name + " ");
  });
  const std::string name = same == 0 ? device.name : device.name + " " + std::to_string(same + 1);
  streams_.push_back(std::make_unique<Stream>(Stream{name, StreamMeter(device.clock), nullptr}));
  if (device.kind != DeviceKind::camera || frames_ == FrameEncoding::as_sent) return;
  streams_.back()->frames = std::make_unique<FrameKeeper>(
      [wish = frames_](std::span<const std::byte> picture, CameraFrame& frame) {
        return encoded(picture, frame, wish);
      },
      [recorder = recorder_.get(), camera = number(streams_.size() - 1)](Transfer transfer,
                                                                         std::optional<CameraFrame> frame) {
        recorder->add(RecordedTransfer{camera, std::move(transfer)});
        if (frame) recorder->add(RecordedSample{camera, *frame, 0});
      });
}

std::string RecordingSession::name_of(std::size_t device) {
  const std::lock_guard lock(mutex_);
  return streams_.at(device)->name;
}

void RecordingSession::keep(std::size_t device, const Transfer& transfer, std::span<const Sample> samples) {
  Stream* stream = nullptr;
  {
    const std::lock_guard lock(mutex_);
    stream = streams_[device].get();
  }
  if (!samples.empty()) stream->meter.decoded_after(monotonic_now() - transfer.time);
  for (const Sample& sample : samples) stream->meter.add(time_of(sample), after_gap(sample));
  samples_ += samples.size();
  if (stream->frames) {
    const auto* frame = samples.empty() ? nullptr : std::get_if<CameraFrame>(&samples.front());
    stream->frames->add(transfer, frame ? std::optional(*frame) : std::nullopt);
    return;
  }
  recorder_->add(RecordedTransfer{number(device), transfer});
  for (const Sample& sample : samples) {
    if (const auto* pen = std::get_if<PenSample>(&sample))
      recorder_->add(RecordedPen{0, number(device), *pen, std::nullopt});
    else
      recorder_->add(RecordedSample{number(device), sample, 0});
  }
}

Result<std::vector<RecordedStream>> RecordingSession::finish() {
  devices_->stop();
  std::vector<RecordedStream> streams;
  const std::vector<ReportCounts> counts = devices_->counts();
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const auto dropped = static_cast<std::int64_t>(counts[i].lost);
    const auto received = static_cast<std::int64_t>(counts[i].reports);
    streams.push_back(
        {streams_[i]->name, received + dropped, received, dropped, streams_[i]->meter.figures(), {}});
    if (streams_[i]->frames) streams.back().frames = streams_[i]->frames->finish();
    recorder_->add(Receipt{number(i), received + dropped, received, dropped});
    for (const ClockLine& line : streams.back().figures.clock)
      recorder_->add(RecordedClockFit{number(i), "", line});
  }
  if (auto closed = recorder_->close(); !closed) return tl::unexpected(closed.error());
  return streams;
}

}  // namespace fude
