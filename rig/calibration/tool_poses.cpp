#include "rig/calibration/tool_poses.h"

#include <utility>

namespace fude {
namespace {

// Of the reference, and of poses that wait for it: 4 s at 1 kHz.
constexpr std::size_t remembered = 4096;

}  // namespace

ToolPoses::ToolPoses(const ToolWish& wish)
    : tool_({.name = wish.tool, .kinds = is_kind<PoseSample>, .but = wish.reference}),
      history_({.samples = remembered}) {
  if (!wish.reference.empty())
    reference_.emplace(StreamWish{
        .name = wish.reference, .what = "reference", .option = "--reference", .kinds = is_kind<PoseSample>});
}

void ToolPoses::begin(DeviceNumber device, const DeviceDescription& description) {
  tool_.begin(device, description);
  if (reference_) reference_->begin(device, description);
}

Result<std::vector<PoseSample>> ToolPoses::hear(DeviceNumber device, const Sample& sample) {
  const auto mine = tool_.takes(device, sample);
  if (!mine) return tl::unexpected(mine.error());
  if (!reference_) {
    if (!*mine) return std::vector<PoseSample>{};
    return std::vector{std::get<PoseSample>(sample)};
  }
  if (*mine) waiting_.push_back(std::get<PoseSample>(sample));
  const auto seen = reference_->takes(device, sample);
  if (!seen) return tl::unexpected(seen.error());
  if (reference_->chosen() && tool_.chosen() && reference_->chosen()->number != tool_.chosen()->number)
    return failure(Fault::usage, "--reference " + reference_->chosen()->part + " is seen by " +
                                     reference_->chosen()->device.name + ", " + tool_.chosen()->part +
                                     " by " + tool_.chosen()->device.name +
                                     ": the same tracker must see both");
  std::vector<PoseSample> out;
  if (*seen) {
    const auto& reference = std::get<PoseSample>(sample);
    history_.add(reference);
    out = ready(reference.time.host);
  }
  if (waiting_.size() > remembered) {
    out.push_back(seen_from_reference(std::move(waiting_.front())));
    waiting_.pop_front();
  }
  return out;
}

Result<std::vector<PoseSample>> ToolPoses::rest() {
  if (const auto found = tool_.found(); !found) return tl::unexpected(found.error());
  if (reference_)
    if (const auto found = reference_->found(); !found) return tl::unexpected(found.error());
  return ready(Timestamp::max());
}

std::vector<PoseSample> ToolPoses::ready(Timestamp until) {
  std::vector<PoseSample> out;
  while (!waiting_.empty() && waiting_.front().time.host <= until) {
    out.push_back(seen_from_reference(std::move(waiting_.front())));
    waiting_.pop_front();
  }
  return out;
}

PoseSample ToolPoses::seen_from_reference(PoseSample sample) const {
  const PoseAnswer from = history_.at(sample.time.host);
  sample.covariance.reset();
  if (from.origin == PoseOrigin::none) {
    sample.valid = false;
    return sample;
  }
  const auto reference_from_tracker = from.tracker_from_tool.inverse();
  sample.tracker_from_tool = {reference_from_tracker.rotation * sample.tracker_from_tool.rotation,
                              reference_from_tracker * sample.tracker_from_tool.translation};
  return sample;
}

void ToolPoses::sign_tool(CalibrationReport& report) const {
  if (!tool_.chosen()) return;
  report.devices = {tool_.chosen()->device.id};
  report.tool = tool_.chosen()->part;
}

void ToolPoses::sign_frame(CalibrationReport& report) const {
  const auto& seen_from = reference_ ? reference_->chosen() : tool_.chosen();
  if (!seen_from) return;
  report.devices = {seen_from->device.id};
  if (reference_) report.reference = seen_from->part;
}

}  // namespace fude
