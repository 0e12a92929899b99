#include "rig/tablet_reader.h"

#include <utility>

namespace fude {

TabletReader::TabletReader(std::unique_ptr<ByteSource> source, PenDecoder& decoder, Heard heard)
    : source_(std::move(source)), decoder_(decoder), heard_(std::move(heard)), thread_([this] { serve(); }) {}

TabletReader::~TabletReader() { stop(); }

bool TabletReader::stop() {
  stopping_ = true;
  source_->wake();
  if (thread_.joinable()) thread_.join();
  return gone_;
}

void TabletReader::serve() {
  while (!stopping_) {
    const auto read = source_->read(std::nullopt);
    if (!read) {
      gone_ = true;
      return;
    }
    if (*read) heard_(**read, decoder_.decode(**read));
  }
}

}  // namespace fude
