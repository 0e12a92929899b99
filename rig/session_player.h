// A session given back as the devices it was recorded from: input devices made by the kernel, poses and
// positions for whoever connects over the network of this machine, and every device to a listener of this
// process.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "capture/session.h"
#include "rig/clock.h"
#include "rig/pose_servers.h"
#include "rig/session_source.h"

namespace fude {

struct PlayWish {
  double speed = 1;    // times the recorded pace; 0: as fast as it is taken, on a manual clock
  Duration from{0};    // after the session's first input
  std::string stream;  // the name of a device, or of a stream of it; empty: all
  PoseServers::Doors doors;
};

// An input device that others can read. Destroying `send` unplugs it.
struct LiveInput {
  std::string node;  // /dev/input/event5
  std::function<Result<void>(std::span<const EvdevEvent>)> send;
};
using MakeLiveInput =
    std::function<Result<LiveInput>(const DeviceDescription& device, std::span<const EvdevEvent> also)>;

// By UinputDevice.
Result<LiveInput> make_uinput(const DeviceDescription& device, std::span<const EvdevEvent> also);

struct PlayedStream {
  std::string name;           // of the device, or of the tracker's tool or marker
  std::string outlet;         // where others find it: "/dev/input/event5"; empty: in this process alone
  std::uint64_t given = 0;    // transfers, poses or positions
  std::uint64_t samples = 0;  // that the driver made of them
};

class SessionPlayer {
 public:
  // Called for every transfer, with what the device's driver made of it. The stamps are the recording's.
  using Heard = std::function<void(DeviceNumber, const Transfer&, std::span<const Sample>)>;

  // Makes the devices, which stand still until play(). `clock` is not used at a speed of 0. Errors: not_found
  // where the session, or the stream of that name, has nothing to play; usage where `from` lies behind its
  // end.
  static Result<std::unique_ptr<SessionPlayer>> open(Session session, const PlayWish& wish,
                                                     std::shared_ptr<Clock> clock, MakeLiveInput make_input);
  ~SessionPlayer();

  // One line for each stream that others cannot have, with the command that mends it; more may come while it
  // plays.
  const std::vector<std::string>& notes() const { return notes_; }
  const std::vector<PlayedStream>& streams() const { return played_; }
  const PoseServers* servers() const { return servers_.get(); }  // null without poses and positions

  // Lets in who connects until `duration` of the machine's own time has passed, `enough` says so, or stop()
  // (then false).
  bool stand(Duration duration, const std::function<bool()>& enough = {});

  // Once: from `from` to the end of the recording or to stop(). True at the end. What changed before `from`
  // is told to each device in one frame first.
  bool play(const Heard& heard);

  // Any thread.
  void stop();

 private:
  struct Device;
  struct Seen {  // by a tracker: a pose or a position
    std::size_t tool = 0;
    std::size_t stream = 0;  // in played_
    const Sample* sample = nullptr;
  };
  SessionPlayer(Session session, const PlayWish& wish, std::shared_ptr<Clock> clock,
                MakeLiveInput make_input);
  void add_device(const RecordedDevice& recorded);
  void add_seen(const std::optional<DeviceNumber>& device, const std::string& part,
                const PoseServers::Doors& doors);
  void make_input(Device& device);
  void lead_in(Device& device);
  void give(Device& device, const Heard& heard);
  void send(Device& device, std::span<const EvdevEvent> events);
  void give(const Seen& seen);
  bool wait_until(Timestamp recorded);

  Session session_;
  PlayTime time_;
  bool patient_;  // as fast as possible: clients on the network are waited for
  std::shared_ptr<Clock> clock_;
  MakeLiveInput make_input_;
  Waker waker_;
  std::atomic<bool> stopping_{false};
  std::vector<std::string> notes_;
  std::vector<PlayedStream> played_;
  std::vector<std::unique_ptr<Device>> devices_;
  std::vector<Seen> seen_;
  std::size_t next_seen_ = 0;
  std::unique_ptr<PoseServers> servers_;
};

}  // namespace fude
