// A session recorded from every device that is plugged in.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "capture/picture/frame_encoding.h"
#include "rig/calibration/passport.h"
#include "rig/devices.h"
#include "rig/frame_keeper.h"
#include "rig/recorder.h"
#include "rig/stream_meter.h"
#include "signal/result.h"

namespace fude {

// What a device should have sent, what came, and what was lost on the way, in reports.
struct RecordedStream {
  std::string device;  // its name; "NAME 2" for the second of a name
  std::int64_t expected = 0;
  std::int64_t received = 0;
  std::int64_t dropped = 0;
  StreamFigures figures;
  std::optional<FrameKeeper::Counts> frames;  // of a camera whose pictures were to be encoded
};

struct RecordingWish {
  bool overwrite = false;  // an existing session, and only when there is something to record
  std::vector<NamedDevice> named;
  CameraSettings camera;  // what every camera is asked for
  FrameEncoding frames = FrameEncoding::as_sent;
  SleepWatch sleep;
  std::vector<StoredCalibration> calibrations;  // the session carries those of the devices that it records
  DeviceListener also = {};                     // `appeared` and `heard` are told what is recorded
};

class RecordingSession {
 public:
  // Records every device that is there or comes. `warn` gets what the user should know meanwhile, from any
  // thread. Errors: not_found where nothing is plugged in or named, no_access where none may be read, those
  // of the recorder.
  static Result<std::unique_ptr<RecordingSession>> start(const std::filesystem::path& session,
                                                         RecordingWish wish,
                                                         std::function<void(const std::string&)> warn);

  // Of all devices so far; any thread.
  std::uint64_t samples() const { return samples_; }

  // Ends and closes the session. Errors: those of the disk; what was written before is kept.
  Result<std::vector<RecordedStream>> finish();

 private:
  struct Stream {
    std::string name;
    StreamMeter meter;
    std::unique_ptr<FrameKeeper> frames;  // null: everything is written as it comes
  };
  RecordingSession(std::unique_ptr<Recorder> recorder, RecordingWish& wish)
      : recorder_(std::move(recorder)),
        frames_(wish.frames),
        passport_(std::move(wish.calibrations)),
        also_(std::move(wish.also)) {}
  void begin(const DeviceDescription& device);
  std::string name_of(std::size_t device);
  void keep(std::size_t device, const Transfer& transfer, std::span<const Sample> samples);

  std::unique_ptr<Recorder> recorder_;
  FrameEncoding frames_;
  Passport passport_;
  DeviceListener also_;
  std::mutex mutex_;  // of the list, not of its streams: each is its reader's
  std::vector<std::unique_ptr<Stream>> streams_;
  std::atomic<std::uint64_t> samples_{0};
  std::unique_ptr<Devices> devices_;
};

}  // namespace fude
