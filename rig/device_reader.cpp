#include "rig/device_reader.h"

#include <utility>

#include "drivers/transport/waker.h"

namespace fude {

DeviceReader::DeviceReader(std::unique_ptr<ByteSource> source, Decoder& decoder, Heard heard)
    : source_(std::move(source)), decoder_(decoder), heard_(std::move(heard)), thread_([this] { serve(); }) {}

DeviceReader::~DeviceReader() { stop(); }

bool DeviceReader::stop() {
  stopping_ = true;
  source_->wake();
  if (thread_.joinable()) thread_.join();
  return gone_;
}

// What the device would not take is not in the recording; its silence shows in what comes after.
void DeviceReader::send(const std::vector<Transfer>& transfers) {
  for (Transfer transfer : transfers) {
    transfer.direction = Direction::to_device;
    transfer.time = monotonic_now();
    transfer.stamped_by = StampedBy::arrival;
    if (source_->write(transfer)) heard_(transfer, {});
  }
}

void DeviceReader::serve() {
  send(decoder_.greeting());
  Decoded decoded;
  while (!stopping_) {
    const auto read = source_->read(std::nullopt);
    if (!read) {
      gone_ = true;
      return;
    }
    if (!*read) continue;
    decoded.samples.clear();
    decoded.replies.clear();
    decoder_.decode(**read, decoded);
    heard_(**read, decoded.samples);
    send(decoded.replies);
    if ((*read)->kind == TransferKind::plugged) send(decoder_.greeting());
  }
}

}  // namespace fude
