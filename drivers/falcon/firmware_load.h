// How a Falcon is given its firmware after power-on: a dialogue through the serial chip. The image is the
// user's own file; fude has none.
#pragma once

#include <cstdint>
#include <vector>

#include "drivers/byte_order.h"
#include "signal/timestamp.h"
#include "signal/transfer.h"

namespace fude::falcon {

class FirmwareLoad {
 public:
  enum class State : std::uint8_t { idle, calling, asking, sending, loaded, failed };

  explicit FirmwareLoad(std::vector<std::byte> image) : image_(std::move(image)) {}

  // Begins (again); none of it is right before the first answer.
  std::vector<Transfer> begin(Timestamp now);

  // What the chip has read, without its status (often nothing: then only the time counts). Gives what to send
  // next. An answer that does not come in a second or is another begins the dialogue again, ten times at
  // most. Each block is echoed and compared.
  std::vector<Transfer> hear(Bytes bytes, Timestamp now);

  State state() const { return state_; }

 private:
  std::vector<Transfer> call(Timestamp now);
  std::vector<Transfer> ask();
  std::vector<Transfer> next_block();
  std::vector<Transfer> again(Timestamp now);

  std::vector<std::byte> image_;
  State state_ = State::idle;
  std::vector<std::byte> heard_;
  std::size_t confirmed_ = 0;  // bytes of the image that came back
  std::size_t sent_ = 0;
  int attempts_ = 0;
  Timestamp since_{};
};

// Speed and latency of the running firmware, and no old bytes.
std::vector<Transfer> normal_mode();

}  // namespace fude::falcon
