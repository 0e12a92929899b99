#include "tests/lab/session_recording.h"

#include <chrono>
#include <stdexcept>
#include <string>
#include <utility>

#include "capture/session.h"
#include "drivers/transport/waker.h"
#include "tests/lab/patience.h"

namespace fude::lab {
namespace {

template <class T>
T sound(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().message);
  if constexpr (!std::is_void_v<T>) return std::move(*result);
}

std::filesystem::path next_file() {
  static int count = 0;
  return std::filesystem::temp_directory_path() / ("lab-" + std::to_string(++count) + ".fude");
}

}  // namespace

SessionRecording::SessionRecording(const DeviceDescription& device)
    : path_(next_file()),
      writer_(sound(SessionWriter::create(path_))),
      device_(sound(writer_.add_device(device))) {}

bool SessionRecording::take(ByteSource& source, Timestamp deadline) {
  const auto transfer = source.read(deadline);
  if (!transfer) {
    error_ = transfer.error();
    return false;
  }
  if (!*transfer) return false;
  add(**transfer);
  return true;
}

std::size_t SessionRecording::drain(ByteSource& source) {
  while (take(source, monotonic_now())) {
  }
  return size_;
}

std::size_t SessionRecording::drain_until(ByteSource& source, std::size_t count) {
  const Timestamp deadline = patience();
  while (size_ < count && take(source, deadline)) {
  }
  return size_;
}

bool SessionRecording::drain_one(ByteSource& source) {
  const std::size_t before = size_;
  return drain_until(source, before + 1) > before;
}

void SessionRecording::add(const Transfer& transfer) {
  sound(writer_.add_transfer(device_, transfer));
  ++size_;
  last_ = transfer;
}

std::vector<Transfer> SessionRecording::finish() {
  sound(writer_.close());
  std::vector<Transfer> transfers;
  Session session = sound(read_session(path_));
  for (RecordedTransfer& recorded : session.transfers) transfers.push_back(std::move(recorded.transfer));
  std::filesystem::remove(path_);
  return transfers;
}

}  // namespace fude::lab
