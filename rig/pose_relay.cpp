#include "rig/pose_relay.h"

#include <limits>
#include <variant>

#include "capture/sample_columns.h"

namespace fude {
namespace {

constexpr std::size_t of_the_rig = std::numeric_limits<std::size_t>::max();  // of no single device

}  // namespace

Result<std::unique_ptr<PoseRelay>> PoseRelay::open(Wish wish, std::function<void(const std::string&)> warn) {
  std::unique_ptr<PoseRelay> relay(new PoseRelay(wish.doors));
  const PoseServers& servers = relay->servers_;
  if (!servers.openigtlink() && !servers.vrpn()) return tl::unexpected(servers.refused().front());
  for (const Error& error : servers.refused()) warn(error.message);
  DeviceListener listener;
  listener.appeared = [raw = relay.get()](std::size_t, const DeviceDescription& device) {
    const std::lock_guard lock(raw->mutex_);
    raw->devices_heard_.push_back(device.name);
  };
  listener.heard = [raw = relay.get()](std::size_t device, const Transfer&, std::span<const Sample> samples) {
    raw->hear(device, samples);
  };
  listener.refused = [warn](const Error& error) { warn(error.message); };
  DevicesWish devices;
  if (wish.fused_with_up) relay->fusion_.emplace(*wish.fused_with_up, wish.fused_ahead);
  devices.wanted = [fused = wish.fused_with_up.has_value()](const AttachedDevice& device) {
    const DeviceKind kind = device.description.kind;
    return kind == DeviceKind::tracker || (fused && kind == DeviceKind::imu);
  };
  devices.named = std::move(wish.named);
  auto opened = Devices::open(std::move(listener), std::move(devices));
  if (!opened) return tl::unexpected(opened.error());
  relay->devices_ = std::move(*opened);
  return relay;
}

void PoseRelay::attend() {
  const std::lock_guard lock(mutex_);
  servers_.attend();
}

std::vector<PoseRelay::Relayed> PoseRelay::relayed() const {
  const std::lock_guard lock(mutex_);
  return relayed_;
}

std::size_t PoseRelay::tool_of(std::size_t device, const Sample& sample) {
  const std::string part = part_of(sample);
  const auto [known, added] = tools_.try_emplace({device, part}, relayed_.size());
  if (added) {
    servers_.add(part.empty() ? devices_heard_.at(device) : part);
    relayed_.push_back({.name = servers_.name(known->second)});
  }
  return known->second;
}

void PoseRelay::hear(std::size_t device, std::span<const Sample> samples) {
  const std::lock_guard lock(mutex_);
  for (const Sample& sample : samples) {
    give(device, sample);
    if (!fusion_) continue;
    if (const auto fused = fusion_->add(device, sample)) give(of_the_rig, *fused);
  }
}

void PoseRelay::give(std::size_t device, const Sample& sample) {
  const auto serve = [&](const auto& seen) {
    const std::size_t tool = tool_of(device, sample);
    servers_.send(tool, seen);
    relayed_[tool].given += seen.valid;
  };
  if (const auto* pose = std::get_if<PoseSample>(&sample)) serve(*pose);
  if (const auto* position = std::get_if<PositionSample>(&sample)) serve(*position);
}

}  // namespace fude
