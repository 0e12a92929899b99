// Polhemus FASTRAK, PATRIOT and LIBERTY: electromagnetic trackers on a serial line or USB.
#pragma once

#include <cstdint>
#include <optional>

#include "drivers/decoder.h"
#include "drivers/frame_stream.h"
#include "drivers/polhemus/record.h"
#include "drivers/wrapping_counter.h"

namespace fude {

// Reads serial and usb_bulk transfers as one stream of bytes. Each record is a PoseSample of its station
// ("1", "2" …), metres, in the frame of the source; all stations of one cycle have one sequence. LIBERTY and
// PATRIOT count their frames, by which losses are seen, and their time is the device_tick in microseconds;
// FASTRAK has neither. A record with an error flag, or more distortion than allowed, is not valid.
//
// greeting() stops the stream, sets binary, centimetres and the output list of every station, and starts
// the stream again.
class PolhemusDecoder final : public Decoder {
 public:
  struct Options {
    polhemus::Layout layout = polhemus::usual_layout(polhemus::Dialect::liberty);
    std::optional<std::uint8_t> usb_out;          // the endpoint commands go to; none: a serial line
    std::optional<std::int32_t> most_distortion;  // none: the level is not judged
  };
  explicit PolhemusDecoder(Options options);
  PolhemusDecoder(std::uint16_t product, bool usb);  // by models.inl; an unknown one is a LIBERTY

  std::vector<Transfer> greeting() override;
  void decode(const Transfer& transfer, Decoded& out) override;

 private:
  void take_record(const polhemus::Record& record, const Transfer& transfer, Decoded& out);
  void begin_cycle(const polhemus::Record& record);

  Options options_;
  FrameStream stream_;
  WrappingCounter frame_{32};
  WrappingCounter time_ms_{32};
  unsigned last_station_ = 0;  // 0: none since the beginning or a gap
  std::uint64_t sequence_ = 0;
  std::uint32_t gap_waits_ = 0;  // stations whose next sample is after the gap, a bit each
};

}  // namespace fude
