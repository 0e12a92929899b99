// A camera as every other family's driver: what a picture is stands with the source that took it.
#pragma once

#include "drivers/decoder.h"
#include "drivers/transport/v4l2_source.h"

namespace fude {

class CameraDecoder final : public Decoder {
 public:
  // The source that the next transfers come from; it must live until they are decoded.
  void watch(const V4l2Source* source) { source_ = source; }

  // One CameraFrame for the picture that `source` gave last.
  void decode(const Transfer& transfer, Decoded& out) override;

 private:
  const V4l2Source* source_ = nullptr;
  std::optional<std::uint64_t> last_;
  bool after_absence_ = false;
};

}  // namespace fude
