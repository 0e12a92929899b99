#include "rig/haptic_reader.h"

#include <utility>

#include "rig/falcon_firmware.h"
#include "rig/precedence.h"

namespace fude {

HapticReader::HapticReader(std::unique_ptr<ByteSource> source, FalconDecoder& decoder, Heard heard,
                           HapticWish wish)
    : source_(std::move(source)),
      decoder_(decoder),
      wish_(std::move(wish)),
      loop_(*source_, *wish_.clock, decoder, std::move(wish_.feel),
            [heard = std::move(heard)](const Transfer& transfer, const Decoded& decoded) {
              heard(transfer, decoded.samples);
            }),
      thread_([this] { serve(); }) {}

HapticReader::~HapticReader() { stop(); }

bool HapticReader::stop() {
  stopping_ = true;
  source_->wake();
  if (thread_.joinable()) thread_.join();
  return gone_;
}

void HapticReader::serve() {
  ask_for(Precedence::arm);
  while (!stopping_) {
    if (!loop_.step()) {
      gone_ = true;
      return;
    }
    say_what_is_missing();
  }
  loop_.part();
}

void HapticReader::say_what_is_missing() {
  const FalconDecoder::State before = std::exchange(state_, decoder_.state());
  if (state_ == before || !wish_.refused) return;
  if (state_ == FalconDecoder::State::no_firmware) wish_.refused(no_falcon_firmware());
  if (state_ == FalconDecoder::State::failed) wish_.refused(falcon_firmware_refused());
}

}  // namespace fude
