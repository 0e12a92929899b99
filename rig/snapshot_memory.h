// Memory for snapshots of the ink, touched before it is needed: the first touch of a page takes longer
// than copying it full, and a stroke begins with a snapshot.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <thread>

#include "sim/ink/ink.h"

namespace fude {

class SnapshotMemory {
 public:
  SnapshotMemory();
  ~SnapshotMemory();
  SnapshotMemory(const SnapshotMemory&) = delete;
  SnapshotMemory& operator=(const SnapshotMemory&) = delete;

  // What has been prepared, as a snapshot to be written over; an empty one where that is nothing yet.
  InkSnapshot take();

  // Prepares memory for so many cells behind the caller, giving way to what paints.
  void prepare(std::size_t cells);

 private:
  void serve();

  std::mutex mutex_;
  std::condition_variable wished_;
  std::size_t wish_ = 0;  // tiles
  InkSnapshot ready_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace fude
