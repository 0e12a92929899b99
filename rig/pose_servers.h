// Poses and positions for whoever connects: one server that speaks OpenIGTLink and one that speaks VRPN.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "drivers/transport/tcp_server.h"
#include "signal/pose_sample.h"
#include "signal/position_sample.h"
#include "signal/result.h"

namespace fude {

class PoseServers {
 public:
  struct Doors {
    std::uint16_t openigtlink = 18944;  // 0: the system picks a free one
    std::uint16_t vrpn = 3883;
    std::string address = "127.0.0.1";  // of this machine; others reach it only where this says so
  };

  // One server may stand without the other: what failed is told in `refused`.
  explicit PoseServers(const Doors& doors);

  // A tool, or a marker, to be served under this name: cut to 20 bytes, and ended by "-2", "-3" … where one
  // stood before. Returns its number.
  std::size_t add(const std::string& name);
  const std::string& name(std::size_t tool) const { return tools_.at(tool); }

  const std::vector<Error>& refused() const { return refused_; }
  const TcpServer* openigtlink() const { return openigtlink_.get(); }  // null where it was refused
  const TcpServer* vrpn() const { return vrpn_.get(); }

  // A TRANSFORM and a Pos_Quat of the tool, stamped with the sample's own host time as if it began in 1970.
  // An invalid pose is not sent: neither protocol could say so. With `patience` it waits for clients that are
  // far behind; without it they are dropped.
  void send(std::size_t tool, const PoseSample& sample, Duration patience = Duration(0));
  // A POSITION without a turn, and a Pos_Quat, which always has one: none.
  void send(std::size_t marker, const PositionSample& sample, Duration patience = Duration(0));

  // Call it a few times a second: lets in who waits at the door.
  void attend();

  // Waits until every client has all, or for `patience`.
  void drain(Duration patience);

 private:
  void send(std::size_t tool, Timestamp time, const Pose<Tracker, Tool>& pose, bool turned,
            Duration patience);

  std::vector<std::string> tools_;
  std::vector<Error> refused_;
  std::unique_ptr<TcpServer> openigtlink_, vrpn_;
};

}  // namespace fude
