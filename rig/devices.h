// The devices of the rig, read as long as they are there. A device that comes back is the same one: it
// keeps its number and its driver, and its next sample follows a gap; so does that of a device which stayed
// while the machine slept.
#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <thread>
#include <vector>

#include "drivers/decoder.h"
#include "drivers/transport/device_nodes.h"
#include "drivers/transport/sleep_watch.h"
#include "rig/attached_devices.h"
#include "rig/device_reader.h"
#include "signal/result.h"

namespace fude {

// Devices are numbered from 0 in the order of their first appearance.
struct DeviceListener {
  std::function<void(std::size_t device, const DeviceDescription&)> appeared;
  // On the reader's thread of that device; plugging in and out come as transfers too.
  std::function<void(std::size_t device, const Transfer&, std::span<const Sample>)> heard;
  // A device that may not be read or does not answer; the message says what to do. Once each absence, from
  // any thread.
  std::function<void(const Error&)> refused;
  // A camera was opened, after `appeared` and again when it is back: what it made of the wish. May be empty.
  std::function<void(std::size_t device, const CameraSettings&)> camera = {};
};

// A device that no udev tells of: a network peer, or a serial line to which anything may be wired.
struct NamedDevice {
  DeviceDescription description;
  const FamilyRow* family = nullptr;
  std::function<Result<std::unique_ptr<ByteSource>>()> open;  // tried again while it fails
};

struct DevicesWish {
  std::function<bool(const AttachedDevice&)> wanted;  // empty: all
  std::vector<NamedDevice> named;
  CameraSettings camera;  // of every camera
  SleepWatch sleep;
};

class Devices {
 public:
  // Starts with the devices that are there (`appeared` is called before open returns) and follows plugging.
  // Errors: unsupported where udev does not answer.
  static Result<std::unique_ptr<Devices>> open(DeviceListener listener, DevicesWish wish);
  ~Devices();
  Devices(const Devices&) = delete;
  Devices& operator=(const Devices&) = delete;

  // Ends all reading; no call of the listener happens after it.
  void stop();

  // Of each device, in the order of their numbers; call it after stop().
  std::vector<ReportCounts> counts() const;

 private:
  struct Slot {
    DeviceDescription description;
    std::filesystem::path node;  // empty while the device is away
    std::unique_ptr<Decoder> decoder;
    std::unique_ptr<Reader> reader;
  };

  Devices(DeviceListener listener, DevicesWish wish, std::unique_ptr<NodeMonitor> monitor);
  void watch();
  void plugged(const AttachedDevice& found);
  void unplugged(const std::filesystem::path& node);
  void add(const NamedDevice& named);
  void read(std::size_t number, std::unique_ptr<ByteSource> source);

  DeviceListener listener_;
  DevicesWish wish_;
  std::unique_ptr<NodeMonitor> monitor_;
  std::vector<Slot> slots_;  // the watching thread's, once it runs
  std::atomic<bool> stopping_{false};
  std::thread watching_;
};

}  // namespace fude
