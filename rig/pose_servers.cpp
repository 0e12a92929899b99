#include "rig/pose_servers.h"

#include <algorithm>
#include <set>
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

std::vector<std::byte> vrpn_welcome(const std::vector<std::string>& tools) {
  std::vector<std::byte> bytes = vrpn::write_cookie();
  append(bytes, vrpn::write_description(vrpn::type_description, pose_type, vrpn::pose_type));
  for (std::size_t i = 0; i < tools.size(); ++i)
    append(bytes, vrpn::write_description(vrpn::sender_description, static_cast<std::int32_t>(i), tools[i]));
  return bytes;
}

}  // namespace

std::vector<std::string> distinct_names(std::vector<std::string> names, std::size_t longest) {
  std::set<std::string> taken;
  for (std::string& name : names) {
    const std::string whole = name;
    name = whole.substr(0, longest);
    for (int again = 2; !taken.insert(name).second; ++again) {
      const std::string end = "-" + std::to_string(again);
      name = whole.substr(0, longest - end.size()) + end;
    }
  }
  return names;
}

PoseServers::PoseServers(std::vector<std::string> tools, Ports ports)
    : tools_(distinct_names(std::move(tools), longest_name)) {
  const auto open = [this](std::unique_ptr<TcpServer>& server, TcpServer::Options options) {
    auto opened = TcpServer::open(std::move(options));
    if (opened)
      server = std::move(*opened);
    else
      refused_.push_back(std::move(opened.error()));
  };
  open(openigtlink_, {.port = ports.openigtlink});
  open(vrpn_, {.port = ports.vrpn, .welcome = vrpn_welcome(tools_)});
}

void PoseServers::send(std::size_t tool, const PoseSample& sample, Duration patience) {
  if (!sample.valid) return;
  const auto send = [patience](TcpServer& server, Bytes message) {
    server.send(message);
    if (patience > Duration(0) && server.waiting_bytes() > far_behind)
      server.drain(monotonic_now() + patience);
  };
  const std::uint64_t time_us = microseconds(sample.time.host);
  if (openigtlink_)
    send(*openigtlink_, openigtlink::write_transform(tools_.at(tool), openigtlink::stamp_of_us(time_us),
                                                     sample.tracker_from_tool));
  if (vrpn_)
    send(*vrpn_, vrpn::write_message({.time_us = time_us,
                                      .sender = static_cast<std::int32_t>(tool),
                                      .type = pose_type,
                                      .body = vrpn::write_pose({0, sample.tracker_from_tool})}));
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
