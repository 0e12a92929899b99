// What the trackers of this rig see, and what is fused of it, given on to other programs as it comes.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "rig/devices.h"
#include "rig/fusion/live_fusion.h"
#include "rig/pose_servers.h"
#include "signal/result.h"

namespace fude {

class PoseRelay {
 public:
  struct Wish {
    PoseServers::Doors doors;
    std::vector<NamedDevice> named;
    // Where given: what the rig's first tool does is fused with its first inertial unit and served as "fused"
    // too. Up, in the tracker's frame.
    std::optional<Eigen::Vector3d> fused_with_up;
    Duration fused_ahead{};  // it is served so much ahead of its time, predicted: for a display
  };
  struct Relayed {
    std::string name;         // under which it is served
    std::uint64_t given = 0;  // valid poses or positions
  };

  // Follows every tracker that is there or comes. `warn` gets what the user should know, from any thread.
  // Errors: busy where neither server may stand, those of Devices::open().
  static Result<std::unique_ptr<PoseRelay>> open(Wish wish, std::function<void(const std::string&)> warn);

  const PoseServers& servers() const { return servers_; }

  // Lets in who wants to connect; call it a few times a second.
  void attend();

  // A tool is there from its first pose on.
  std::vector<Relayed> relayed() const;

 private:
  explicit PoseRelay(const PoseServers::Doors& doors) : servers_(doors) {}
  void hear(std::size_t device, std::span<const Sample> samples);
  void give(std::size_t device, const Sample& sample);
  std::size_t tool_of(std::size_t device, const Sample& sample);

  mutable std::mutex mutex_;  // of all below but the devices: every reader's thread comes in here
  PoseServers servers_;
  std::vector<std::string> devices_heard_;  // their names
  std::map<std::pair<std::size_t, std::string>, std::size_t> tools_;
  std::vector<Relayed> relayed_;  // by tool
  std::optional<LiveFusion> fusion_;
  std::unique_ptr<Devices> devices_;  // ends its readers before the rest goes
};

}  // namespace fude
