// Poses for whoever connects: one server that speaks OpenIGTLink and one that speaks VRPN, for programs of
// this machine.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "drivers/transport/tcp_server.h"
#include "signal/pose_sample.h"
#include "signal/result.h"

namespace fude {

class PoseServers {
 public:
  struct Ports {
    std::uint16_t openigtlink = 18944;  // 0: the system picks a free one
    std::uint16_t vrpn = 3883;
  };

  // `tools` are the names that the poses will be served under. One server may stand without the other: what
  // failed is told in `refused`.
  PoseServers(std::vector<std::string> tools, Ports ports);

  const std::vector<Error>& refused() const { return refused_; }
  const TcpServer* openigtlink() const { return openigtlink_.get(); }  // null where it was refused
  const TcpServer* vrpn() const { return vrpn_.get(); }

  // A TRANSFORM and a Pos_Quat of tools[tool], stamped with the sample's own host time as if it began in
  // 1970. An invalid pose is not sent: neither protocol could say so. With `patience` it waits for clients
  // that are far behind; without it they are dropped.
  void send(std::size_t tool, const PoseSample& sample, Duration patience = Duration(0));

  // Call it a few times a second: lets in who waits at the door.
  void attend();

  // Waits until every client has all, or for `patience`.
  void drain(Duration patience);

 private:
  std::vector<std::string> tools_;
  std::vector<Error> refused_;
  std::unique_ptr<TcpServer> openigtlink_, vrpn_;
};

// The names, each cut to `longest` bytes and, where one stood before, ended by "-2", "-3" …
std::vector<std::string> distinct_names(std::vector<std::string> names, std::size_t longest);

}  // namespace fude
