// Frames in a stream of bytes: where one begins is found by what it must look like, so that garbage,
// a lost byte or a read that ends in the middle costs no more than the frames it touched.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "drivers/byte_order.h"

namespace fude {

// What stands at the front of the stream. `length`: of a whole or a foreign frame; of a damaged one what is
// stepped over, at least a byte.
struct FrameFit {
  enum class Kind : std::uint8_t {
    none,
    needs_more,
    damaged,
    whole,
    foreign,  // of no use here, and stepped over as it comes, however long
  };
  Kind kind = Kind::none;
  std::size_t length = 0;
};

class FrameStream {
 public:
  struct Fed {
    std::uint64_t damaged = 0;  // places that looked like a frame and were none
    std::uint64_t foreign = 0;
  };

  // Calls `take(frame)` for each whole frame. `fit(bytes)` is asked where a frame may begin; `needs_more` is
  // believed up to `longest` bytes.
  template <class Fit, class Take>
  Fed feed(Bytes bytes, std::size_t longest, Fit&& fit, Take&& take) {
    Fed fed;
    const std::size_t stepped = std::min(to_step_over_, bytes.size());
    to_step_over_ -= stepped;
    append(waiting_, bytes.subspan(stepped));
    const Bytes all(waiting_);
    std::size_t at = 0;
    while (at < all.size()) {
      const FrameFit found = fit(all.subspan(at));
      switch (found.kind) {
        case FrameFit::Kind::whole:
          take(all.subspan(at, found.length));
          at += found.length;
          continue;
        case FrameFit::Kind::foreign:
          ++fed.foreign;
          to_step_over_ = found.length - std::min(found.length, all.size() - at);
          at += found.length - to_step_over_;
          continue;
        case FrameFit::Kind::damaged:
          ++fed.damaged;
          at += std::clamp<std::size_t>(found.length, 1, all.size() - at);
          continue;
        case FrameFit::Kind::needs_more:
          if (all.size() - at < longest) return keep(at), fed;
          [[fallthrough]];
        case FrameFit::Kind::none:
          ++at;
      }
    }
    keep(at);
    return fed;
  }

  void forget() {
    waiting_.clear();
    to_step_over_ = 0;
  }

 private:
  void keep(std::size_t from) {
    waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(from));
  }

  std::vector<std::byte> waiting_;
  std::size_t to_step_over_ = 0;
};

}  // namespace fude
