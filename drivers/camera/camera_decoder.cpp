#include "drivers/camera/camera_decoder.h"

namespace fude {

void CameraDecoder::decode(const Transfer& transfer, Decoded& out) {
  if (transfer.kind == TransferKind::unplugged || transfer.kind == TransferKind::suspended) {
    after_absence_ = true;
    last_.reset();
  }
  if (transfer.kind != TransferKind::picture || source_ == nullptr) return;
  CameraFrame frame = source_->frame();
  if (last_ && frame.time.sequence > *last_ + 1) counts_.lost += frame.time.sequence - *last_ - 1;
  last_ = frame.time.sequence;
  frame.after_gap = frame.after_gap || after_absence_;
  after_absence_ = false;
  ++counts_.reports;
  ++counts_.samples;
  out.samples.emplace_back(frame);
}

}  // namespace fude
