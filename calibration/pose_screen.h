// What is wrong with a tracker's poses before any fit: counted and named, and kept out of it.
#pragma once

#include <cstddef>
#include <optional>

#include "calibration/report.h"
#include "signal/pose_sample.h"

namespace fude {

class PoseScreen {
 public:
  enum class Finding {
    sound,
    repeat,   // to the last bit the pose before it: a frozen tracker, or one that says things twice
    unusable  // not seen, no number, or no rotation
  };
  Finding look(const PoseSample& sample);

  // What comes now is another session, with times of its own.
  void begin_again() { last_.reset(); }

  std::size_t seen() const { return seen_; }
  std::size_t repeats() const { return repeats_; }
  bool frozen() const { return seen_ > unusable_ + 1 && repeats_ + unusable_ + 1 >= seen_; }

  // One warning for each thing that happened.
  void warn(CalibrationReport& report) const;

 private:
  std::size_t seen_ = 0, unusable_ = 0, repeats_ = 0, backwards_ = 0;
  std::optional<PoseSample> last_;
};

}  // namespace fude
