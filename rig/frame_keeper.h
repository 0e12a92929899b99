// A camera's pictures brought into the form in which they are recorded, on a thread of their own: neither the
// camera's reader nor another device waits for it.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <span>
#include <thread>
#include <vector>

#include "signal/camera_frame.h"
#include "signal/result.h"
#include "signal/transfer.h"

namespace fude {

class FrameKeeper {
 public:
  // As encoded() does (capture/picture/frame_encoding.h).
  using Encode = std::function<Result<std::vector<std::byte>>(std::span<const std::byte>, CameraFrame&)>;
  // What is to be kept, in the order of add(); on the keeper's thread.
  using Keep = std::function<void(Transfer, std::optional<CameraFrame>)>;

  FrameKeeper(Encode encode, Keep keep);
  ~FrameKeeper();  // finishes
  FrameKeeper(const FrameKeeper&) = delete;
  FrameKeeper& operator=(const FrameKeeper&) = delete;

  // Never waits. A picture with its frame is encoded, unless one waits for that already or it cannot be: then
  // it is kept as sent. Whatever else the camera's wire carried stays as it is.
  void add(Transfer transfer, std::optional<CameraFrame> frame);

  struct Counts {
    std::uint64_t as_wished = 0;
    std::uint64_t as_sent = 0;
  };
  // Keeps what is queued and ends.
  Counts finish();

 private:
  struct Item {
    Transfer transfer;
    std::optional<CameraFrame> frame;
    bool to_encode = false;
  };
  void serve();
  void keep(Item item);

  Encode encode_;
  Keep keep_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<Item> queue_;
  std::size_t waiting_ = 0;  // of the queue, to be encoded
  bool ending_ = false;
  Counts counts_;
  std::thread thread_;
};

}  // namespace fude
