// What a source gives, put into a session file and read back from it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <vector>

#include "capture/session_writer.h"
#include "signal/byte_source.h"
#include "signal/device.h"

namespace fude::lab {

// Throws std::runtime_error with the message of any error of the session's.
class SessionRecording {
 public:
  explicit SessionRecording(const DeviceDescription& device);

  // Records what `source` has now; returns how many transfers were recorded in all. Stops at the fault
  // that reading ended in, which `error()` then holds.
  std::size_t drain(ByteSource& source);
  // The same until there are `count` in all or `patience()` is at its end.
  std::size_t drain_until(ByteSource& source, std::size_t count);
  // One more; false when none came.
  bool drain_one(ByteSource& source);
  void add(const Transfer& transfer);
  std::size_t size() const { return size_; }
  const Transfer& last() const { return last_; }
  const std::optional<Error>& error() const { return error_; }

  // Closes the session and gives what its file holds.
  std::vector<Transfer> finish();

 private:
  bool take(ByteSource& source, Timestamp deadline);

  std::filesystem::path path_;
  SessionWriter writer_;
  DeviceNumber device_ = 0;
  std::size_t size_ = 0;
  Transfer last_;
  std::optional<Error> error_;
};

}  // namespace fude::lab
