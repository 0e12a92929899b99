#include "capture/recorded_pictures.h"

namespace fude {

RecordedPictures::RecordedPictures(const Session& session, DeviceNumber camera) {
  for (const RecordedTransfer& recorded : session.transfers)
    if (recorded.device == camera && recorded.transfer.kind == TransferKind::picture)
      transfers_.push_back(&recorded.transfer);
}

const Transfer* RecordedPictures::of(const CameraFrame& frame) {
  while (next_ < transfers_.size() && transfers_[next_]->time < frame.time.host) ++next_;
  if (next_ == transfers_.size() || transfers_[next_]->time != frame.time.host) return nullptr;
  return transfers_[next_++];
}

}  // namespace fude
