#include "rig/calibration/live_hearing.h"

#include <string>
#include <utility>

#include "rig/calibration/calibrate_session.h"

namespace fude {

LiveHearing::LiveHearing(Calibrator& calibrator, const Room& room) : calibrator_(calibrator), room_(room) {
  thread_ = std::thread([this] { run(); });
}

LiveHearing::~LiveHearing() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
    waiting_.clear();
  }
  changed_.notify_one();
  if (thread_.joinable()) thread_.join();
}

void LiveHearing::begin(std::size_t device, const DeviceDescription& description) {
  put({static_cast<DeviceNumber>(device) + 1, description, std::nullopt});
}

void LiveHearing::hear(std::size_t device, const Transfer& transfer, std::span<const Sample> samples) {
  for (const Sample& sample : samples) {
    Input input{static_cast<DeviceNumber>(device) + 1, sample, std::nullopt};
    if (std::holds_alternative<CameraFrame>(sample) && transfer.kind == TransferKind::picture)
      input.picture = transfer;
    put(std::move(input));
  }
}

void LiveHearing::put(Input input) {
  {
    const std::lock_guard lock(mutex_);
    if (input.picture) {
      if (pictures_waiting_ >= room_.pictures) return;
      ++pictures_waiting_;
    } else if (std::holds_alternative<Sample>(input.what) && waiting_.size() >= room_.inputs) {
      ++left_out_;
      return;
    }
    waiting_.push_back(std::move(input));
  }
  changed_.notify_one();
}

void LiveHearing::run() {
  for (;;) {
    Input input;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return ending_ || !waiting_.empty(); });
      if (waiting_.empty()) return;
      input = std::move(waiting_.front());
      waiting_.pop_front();
      if (input.picture) --pictures_waiting_;
      if (!progress_) continue;  // it cannot go on
    }
    take(input);
  }
}

void LiveHearing::take(const Input& input) {
  if (const auto* device = std::get_if<DeviceDescription>(&input.what)) {
    calibrator_.begin(input.device, *device);
    return;
  }
  auto progress =
      calibrator_.hear(input.device, std::get<Sample>(input.what), input.picture ? &*input.picture : nullptr);
  const std::lock_guard lock(mutex_);
  progress_ = std::move(progress);
}

Result<Progress> LiveHearing::progress() const {
  const std::lock_guard lock(mutex_);
  return progress_;
}

Result<CalibrationOutcome> LiveHearing::finish() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_one();
  if (thread_.joinable()) thread_.join();
  if (!progress_) return tl::unexpected(progress_.error());
  auto outcome = finish_today(calibrator_);
  if (outcome && left_out_ > 0)
    outcome->report.warnings.push_back(std::to_string(left_out_) +
                                       " samples came faster than they could be heard, and were left out");
  return outcome;
}

}  // namespace fude
