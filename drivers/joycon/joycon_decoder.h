// A Nintendo Joy-Con: buttons, battery and its inertial unit at 200 Hz.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "drivers/decoder.h"
#include "drivers/frame_stream.h"
#include "drivers/joycon/calibration.h"
#include "drivers/joycon/report.h"
#include "drivers/wrapping_counter.h"

namespace fude {

// Reads hid_report transfers, and `serial` ones of the rail. Each full report gives three ImuSamples,
// oldest first, in the frame of the chip: all have the report's host stamp, and a device_tick in
// microseconds, 5 ms apart, from the report's timer (the newest sample is the timer's). The sequence
// counts samples: where the timer shows that some did not come it goes on by as many.
//
// greeting() begins a dialogue, one question at a time, the next when the device has answered: unit on,
// factory calibration, user calibration, full reports at 60 Hz. A question without an answer is asked
// again after half a second of reports, four times at most. Until a calibration has been read a count is
// what models.inl says. What the flash holds is believed only in answer to a question of this decoder or one
// that it saw go by: half a dialogue, overheard, does not change the scale of a recording.
class JoyconDecoder final : public Decoder {
 public:
  explicit JoyconDecoder(std::uint16_t product = 0x2006);

  std::vector<Transfer> greeting() override;
  void decode(const Transfer& transfer, Decoded& out) override;

  bool calibrated() const { return calibrated_; }

 private:
  void take_report(Bytes report, const Transfer& transfer, Decoded& out);
  void take_full(const joycon::FullReport& full, const Transfer& transfer, Decoded& out);
  void take_reply(const joycon::Reply& reply, const Transfer& transfer, Decoded& out);
  void take_flash(const joycon::Reply& reply);
  std::uint64_t advance_timer(std::uint8_t timer, const Transfer& transfer);
  void ask(std::size_t question, const Transfer* cause, std::vector<Transfer>& out);
  void ask_again_if_late(const Transfer& transfer, Decoded& out);
  void forget();

  joycon::InertialScale nominal_;
  joycon::InertialScale scale_;
  bool calibrated_ = false;

  std::size_t question_;  // the one that waits for its answer; past the last when the dialogue is over
  std::optional<Timestamp> asked_;
  int repeats_ = 0;
  std::uint8_t packet_ = 0;
  bool flash_asked_ = false;

  FrameStream rail_;
  WrappingCounter timer_{8};
  Timestamp last_report_{};
  std::optional<std::uint64_t> last_full_;  // the timer at the last report with samples
  std::uint64_t sequence_ = 0;
  bool after_gap_ = false;
};

}  // namespace fude
