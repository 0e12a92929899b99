#include "rig/snapshot_memory.h"

#include <sys/resource.h>
#include <unistd.h>

#include <new>
#include <utility>

#include "sim/ink/tile_layout.h"

namespace fude {
namespace {

constexpr int politeness = 10;

}  // namespace

SnapshotMemory::SnapshotMemory() : thread_([this] { serve(); }) {}

SnapshotMemory::~SnapshotMemory() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wished_.notify_one();
  thread_.join();
}

InkSnapshot SnapshotMemory::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(ready_, {});
}

void SnapshotMemory::prepare(std::size_t cells) {
  {
    const std::lock_guard lock(mutex_);
    wish_ = cells / tile::cells;
  }
  wished_.notify_one();
}

void SnapshotMemory::serve() {
  // On Linux a thread of its own; not the idle class, which a busy machine would never let end.
  (void)setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), politeness);
  std::unique_lock lock(mutex_);
  for (;;) {
    wished_.wait(lock, [this] { return stopping_ || ready_.tiles.size() < wish_; });
    if (stopping_) return;
    lock.unlock();
    InkSnapshot::Tile tile{};
    try {
      tile.planes.resize(tile::paper_begin * tile::cells);
    } catch (const std::bad_alloc&) {
      // The snapshot itself will say so.
    }
    lock.lock();
    if (tile.planes.empty())
      wish_ = 0;
    else
      ready_.tiles.push_back(std::move(tile));
  }
}

}  // namespace fude
