// Writes a session while others paint or read devices: a thread of its own, a queue that loses
// nothing, and the disk some 25 ms behind.
#pragma once

#include <condition_variable>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include "capture/session.h"
#include "signal/result.h"

namespace fude {

// One thing to be written. `order` of pens and actions is given by the recorder.
struct SessionSetting {
  std::string key;
  std::string value;
};
using SessionRecord =
    std::variant<SessionSetting, DeviceDescription, RecordedTransfer, RecordedPen, RecordedSample,
                 RecordedAction, Receipt, RecordedClockFit, RecordedCalibration, RecordedSheet>;

class Recorder {
 public:
  // Errors: those of SessionWriter::create.
  static Result<std::unique_ptr<Recorder>> open(const std::filesystem::path& path);
  ~Recorder();  // closes the session if close() was not called
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  // Any thread; never waits for the disk. Devices are numbered 1, 2 … in the order they are added.
  void add(SessionRecord record);

  // The first error of the disk so far; what was written before it is kept.
  std::optional<Error> failed() const;

  // Writes what is queued and ends the session.
  Result<void> close();

 private:
  class Writing;
  explicit Recorder(std::unique_ptr<Writing> writing);
  void serve();

  std::unique_ptr<Writing> writing_;
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::vector<SessionRecord> queue_;
  std::optional<Error> failed_;
  bool closing_ = false;
  std::thread thread_;
};

}  // namespace fude
