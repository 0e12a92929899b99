// A session recorded from the tablets that are plugged in.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "rig/recorder.h"
#include "rig/tablets.h"
#include "signal/result.h"

namespace fude {

// What a tablet should have sent, what came, and what was lost on the way, in reports.
struct RecordedStream {
  std::string device;
  std::int64_t expected = 0;
  std::int64_t received = 0;
  std::int64_t dropped = 0;
};

class RecordingSession {
 public:
  // Records every tablet that is there or comes; an existing session is replaced only with `overwrite`,
  // and only when there is a tablet to record. `warn` gets what the painter should know meanwhile,
  // from any thread. Errors: not_found where no tablet is plugged in, no_access where none may be
  // read, those of the recorder.
  static Result<std::unique_ptr<RecordingSession>> start(const std::filesystem::path& session, bool overwrite,
                                                         std::function<void(const std::string&)> warn);

  // Ends and closes the session. Errors: those of the disk; what was written before is kept.
  Result<std::vector<RecordedStream>> finish();

 private:
  RecordingSession(std::unique_ptr<Recorder> recorder) : recorder_(std::move(recorder)) {}

  std::unique_ptr<Recorder> recorder_;
  std::vector<std::string> names_;  // written by the watching thread, read after it has ended
  std::unique_ptr<Tablets> tablets_;
};

}  // namespace fude
