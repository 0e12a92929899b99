// Each time a pen was pressed on its tablet: where it rested, how it leaned and how hard it pressed.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "signal/pen_sample.h"

namespace fude {

// Medians over the middle half of the contact, by time: while it lands and leaves a nib slides.
struct PenPress {
  Timestamp first{}, last{};  // in contact
  std::size_t samples = 0;
  Eigen::Vector2d counts = Eigen::Vector2d::Zero();
  Eigen::Vector2d wandered_counts = Eigen::Vector2d::Zero();  // from lowest to highest, in that half
  bool tells_tilt = false;
  Eigen::Vector2d lean = Eigen::Vector2d::Zero();  // tangents of tilt_x and tilt_y; 0 where it does not tell
  double pressure = 0;                             // 0 to 1 of the device's range
};

// Contacts that follow each other within 60 ms are one press; one of less than 20 ms or three samples is
// none. Samples without numbers are passed over; time that runs backwards ends a press.
class PressListener {
 public:
  void add(const PenSample& sample);

  // So far, without one that goes on.
  const std::vector<PenPress>& presses() const { return presses_; }
  // With it.
  std::vector<PenPress> all() const;

 private:
  void close();

  std::vector<PenSample> contact_;
  std::optional<Timestamp> lifted_;  // since its last sample
  std::vector<PenPress> presses_;
};

// Tangents of tilt_x and tilt_y, tilts beyond 80° counted as 80°; 0 where the pen does not tell. The same
// bits on every machine.
Eigen::Vector2d lean_of(const PenSample& pen);

}  // namespace fude
