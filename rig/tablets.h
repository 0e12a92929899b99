// The pen tablets that are plugged in, read as long as they are there. A tablet that comes back is
// the same one: it keeps its number and its decoder, and its next sample follows a gap.
#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

#include "drivers/tablet/pen_decoder.h"
#include "drivers/transport/evdev_devices.h"
#include "rig/tablet_reader.h"
#include "signal/result.h"

namespace fude {

// Tablets are numbered from 0 in the order of their first appearance.
struct TabletListener {
  std::function<void(std::size_t tablet, const DeviceDescription&)> appeared;
  // On the reader's thread of that tablet; plugging in and out come as transfers too.
  std::function<void(std::size_t tablet, const Transfer&, const std::optional<PenSample>&)> heard;
  // A tablet that may not be read; the message says what to do.
  std::function<void(const Error&)> refused;
};

class Tablets {
 public:
  // Starts with the tablets that are there (`appeared` is called before open returns) and follows
  // plugging. Errors: unsupported where udev does not answer.
  static Result<std::unique_ptr<Tablets>> open(TabletListener listener);
  ~Tablets();
  Tablets(const Tablets&) = delete;
  Tablets& operator=(const Tablets&) = delete;

  // Ends all reading; no call of the listener happens after it.
  void stop();

  // Of each tablet, in the order of their numbers; call it after stop().
  std::vector<DecodeCounts> counts() const;

 private:
  struct Slot {
    DeviceDescription description;
    std::filesystem::path node;  // empty while the tablet is away
    std::unique_ptr<PenDecoder> decoder;
    std::unique_ptr<TabletReader> reader;
  };

  Tablets(TabletListener listener, std::unique_ptr<PlugMonitor> monitor);
  void watch();
  void plugged(const FoundDevice& found);
  void unplugged(const std::filesystem::path& node);

  TabletListener listener_;
  std::unique_ptr<PlugMonitor> monitor_;
  std::vector<Slot> slots_;  // the watching thread's, and before and after it the owner's
  std::atomic<bool> stopping_{false};
  std::thread watching_;
};

}  // namespace fude
