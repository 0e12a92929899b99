// fude's own brush handle: gyroscope, accelerometer, magnetometer and buttons at up to 1 kHz.
#pragma once

#include <optional>

#include "drivers/decoder.h"
#include "drivers/handle/report.h"
#include "drivers/numbered_stream.h"

namespace fude {

// Reads hid_report and hid_feature transfers. greeting() asks for the scale, without which a count means
// nothing: until it has come a report gives no sample (and its loss shows in the sequence), and the
// question is repeated every 200 ms of reports. Each report then is one ImuSample in the frame of the
// handle, with device_tick in microseconds; `saturated` where a gyroscope or accelerometer count is the last
// of its range, `magnetic_field_ut` only in reports with a new one.
class HandleDecoder final : public Decoder {
 public:
  std::vector<Transfer> greeting() override;
  void decode(const Transfer& transfer, Decoded& out) override;

  const std::optional<handle::Scale>& scale() const { return scale_; }

 private:
  void take_motion(const handle::Motion& motion, const Transfer& transfer, Decoded& out);

  std::optional<handle::Scale> scale_;
  std::optional<Timestamp> asked_;
  NumberedStream stream_;
  bool after_gap_ = false;
};

}  // namespace fude
