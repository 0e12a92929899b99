// Frames in a stream of bytes: where one begins is found by what it must look like, so that garbage,
// a lost byte or a read that ends in the middle costs no more than the frames it touched.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "drivers/byte_order.h"

namespace fude {

// What stands at the front of the stream.
struct FrameFit {
  enum class Kind : std::uint8_t { none, needs_more, damaged, whole };
  Kind kind = Kind::none;
  std::size_t length = 0;  // of a whole frame
};

class FrameStream {
 public:
  // Calls `take(frame)` for each whole frame and gives how many places looked like a frame and were none.
  // `fit(bytes)` is asked at each byte; `needs_more` is believed up to `longest` bytes.
  template <class Fit, class Take>
  std::uint64_t feed(Bytes bytes, std::size_t longest, Fit&& fit, Take&& take) {
    append(waiting_, bytes);
    const Bytes all(waiting_);
    std::uint64_t damaged = 0;
    std::size_t at = 0;
    while (at < all.size()) {
      const FrameFit found = fit(all.subspan(at));
      if (found.kind == FrameFit::Kind::whole) {
        take(all.subspan(at, found.length));
        at += found.length;
        continue;
      }
      if (found.kind == FrameFit::Kind::needs_more && all.size() - at < longest) break;
      damaged += found.kind == FrameFit::Kind::damaged;
      ++at;
    }
    waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(at));
    return damaged;
  }

  void forget() { waiting_.clear(); }

 private:
  std::vector<std::byte> waiting_;
};

}  // namespace fude
