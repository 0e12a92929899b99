#include "rig/pose_servers.h"

#include <algorithm>
#include <utility>

#include "drivers/openigtlink/content.h"
#include "drivers/transport/waker.h"
#include "drivers/vrpn/message.h"

namespace fude {
namespace {

constexpr std::size_t longest_name = 20;  // of an OpenIGTLink device
constexpr std::size_t far_behind = std::size_t{1} << 19;
constexpr std::int32_t pose_type = 0;

std::uint64_t microseconds(Timestamp time) {
  using std::chrono::microseconds;
  const auto count = std::chrono::duration_cast<microseconds>(time.time_since_epoch()).count();
  return static_cast<std::uint64_t>(std::max<std::int64_t>(count, 0));
}

std::vector<std::byte> vrpn_welcome() {
  std::vector<std::byte> bytes = vrpn::write_cookie();
  append(bytes, vrpn::write_description(vrpn::type_description, pose_type, vrpn::pose_type));
  return bytes;
}

// Cut, and told apart from those that stand before.
std::string distinct_name(const std::string& whole, const std::vector<std::string>& taken) {
  std::string name = whole.substr(0, longest_name);
  for (int again = 2; std::ranges::find(taken, name) != taken.end(); ++again) {
    const std::string end = "-" + std::to_string(again);
    name = whole.substr(0, longest_name - end.size()) + end;
  }
  return name;
}

}  // namespace

PoseServers::PoseServers(const Doors& doors) {
  const auto open = [this](std::unique_ptr<TcpServer>& server, TcpServer::Options options) {
    auto opened = TcpServer::open(std::move(options));
    if (opened)
      server = std::move(*opened);
    else
      refused_.push_back(std::move(opened.error()));
  };
  open(openigtlink_, {.address = doors.address, .port = doors.openigtlink});
  open(vrpn_, {.address = doors.address, .port = doors.vrpn, .welcome = vrpn_welcome()});
}

std::size_t PoseServers::add(const std::string& name) {
  const std::size_t tool = tools_.size();
  tools_.push_back(distinct_name(name, tools_));
  if (vrpn_)
    vrpn_->announce(
        vrpn::write_description(vrpn::sender_description, static_cast<std::int32_t>(tool), tools_.back()));
  return tool;
}

void PoseServers::send(std::size_t tool, const PoseSample& sample, Duration patience) {
  if (sample.valid) send(tool, sample.time.host, sample.tracker_from_tool, true, patience);
}

void PoseServers::send(std::size_t marker, const PositionSample& sample, Duration patience) {
  if (!sample.valid) return;
  Pose<Tracker, Tool> place;
  place.translation = sample.tracker_from_marker_m;
  send(marker, sample.time.host, place, false, patience);
}

void PoseServers::send(std::size_t tool, Timestamp time, const Pose<Tracker, Tool>& pose, bool turned,
                       Duration patience) {
  const auto send = [patience](TcpServer& server, Bytes message) {
    server.send(message);
    if (patience > Duration(0) && server.waiting_bytes() > far_behind)
      server.drain(monotonic_now() + patience);
  };
  const std::uint64_t time_us = microseconds(time);
  const std::uint64_t stamp = openigtlink::stamp_of_us(time_us);
  const std::string& name = tools_.at(tool);
  if (openigtlink_)
    send(*openigtlink_, turned ? openigtlink::write_transform(name, stamp, pose)
                               : openigtlink::write_position(name, stamp, pose.translation));
  if (vrpn_)
    send(*vrpn_, vrpn::write_message({.time_us = time_us,
                                      .sender = static_cast<std::int32_t>(tool),
                                      .type = pose_type,
                                      .body = vrpn::write_pose({0, pose})}));
}

void PoseServers::attend() {
  for (TcpServer* server : {openigtlink_.get(), vrpn_.get()})
    if (server) server->attend();
}

void PoseServers::drain(Duration patience) {
  const Timestamp deadline = monotonic_now() + patience;
  for (TcpServer* server : {openigtlink_.get(), vrpn_.get()})
    if (server) server->drain(deadline);
}

}  // namespace fude
