// A calibrator that hears devices as they are read: their threads put what they read into a bounded queue,
// one thread hears it.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <span>
#include <thread>
#include <variant>

#include "rig/calibration/calibrator.h"
#include "signal/sample.h"
#include "signal/transfer.h"

namespace fude {

class LiveHearing {
 public:
  // What may wait; beyond it what comes is left out, and counted. Pictures come faster than a board is found
  // in them: few may wait, and those left out are no loss.
  struct Room {
    std::size_t inputs = 65536;
    std::size_t pictures = 2;
  };

  // `calibrator` is this thread's until finish().
  explicit LiveHearing(Calibrator& calibrator) : LiveHearing(calibrator, Room{}) {}
  LiveHearing(Calibrator& calibrator, const Room& room);
  ~LiveHearing();
  LiveHearing(const LiveHearing&) = delete;
  LiveHearing& operator=(const LiveHearing&) = delete;

  // From any thread; devices are numbered from 0, as the rig numbers them (rig/devices.h).
  void begin(std::size_t device, const DeviceDescription& description);
  void hear(std::size_t device, const Transfer& transfer, std::span<const Sample> samples);

  // How far it has come, or why it cannot go on.
  Result<Progress> progress() const;

  // Hears what still waits and ends. A warning says what was left out. Errors: those of the calibrator.
  Result<CalibrationOutcome> finish();

 private:
  struct Input {
    DeviceNumber device = 0;
    std::variant<DeviceDescription, Sample> what;
    std::optional<Transfer> picture;
  };
  void put(Input input);
  void run();
  void take(const Input& input);

  Calibrator& calibrator_;
  Room room_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Input> waiting_;
  std::size_t pictures_waiting_ = 0;
  std::uint64_t left_out_ = 0;
  Result<Progress> progress_;
  bool ending_ = false;
  std::thread thread_;
};

}  // namespace fude
