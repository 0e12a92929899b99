// How the handle stands where a device does not say: a mouse, or a pen that does not sense its tilt. It is
// inferred from where the nib is, how it goes and how hard it presses; a pen that senses its tilt keeps it.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <string>

#include "calibration/pen_mapping.h"
#include "capture/session.h"
#include "signal/pen_sample.h"
#include "signal/result.h"
#include "signal/units.h"

namespace fude {

enum class HoldingManner : std::uint8_t {
  upright,  // straight up
  fixed,    // always the same lean
  hand,  // leans to the elbow of the right arm: more, the further the hand reaches and the harder it presses
  left_hand,  // the same on the other side
  travel,     // leans ahead, so that the tip trails
};

struct PenManner {
  HoldingManner kind = HoldingManner::upright;
  // Of `fixed`: the lean of the upper end to the right and towards the painter, within 80°.
  Radians right{};
  Radians towards{};
  bool operator==(const PenManner&) const = default;
};

// "upright", "hand", "left-hand", "travel", "fixed" (20 degrees to the right, 15 towards the painter) or
// "fixed:RIGHT,TOWARDS" in degrees. Errors: usage, naming the words there are.
Result<PenManner> parse_manner(const std::string& text);

// Reads back as the same manner.
std::string as_text(const PenManner& manner);

// The lean of the upper end over the sheet, as tangents: x to the right, y away from the painter.
using Lean = Eigen::Vector2d;

// Of a hand whose elbow rests beside and below the sheet. `nib_mm` on the paper, pressure 0 to 1.
Lean lean_of_hand(const Eigen::Vector2d& nib_mm, double pressure, Extent sheet, bool left_handed);

// The lean of a brush that trails its tip. A straight way gives the same lean however often it is sampled, to
// a thousandth of a radian; where the nib rests the lean stays.
class TrailingLean {
 public:
  // The nib comes to `nib_mm` `seconds` after the last call; more than a quarter of a second: from nowhere,
  // with the lean it had.
  const Lean& follow(const Eigen::Vector2d& nib_mm, double seconds);

 private:
  bool placed_ = false;
  Eigen::Vector2d nib_mm_ = Eigen::Vector2d::Zero();
  Eigen::Vector2d velocity_ = Eigen::Vector2d::Zero();  // smoothed, mm/s
  Lean lean_ = Lean::Zero();
};

// Gives the samples of all devices of a painting their lean, in their order.
class HeldPens {
 public:
  HeldPens(const PenManner& manner, Extent sheet) : manner_(manner), sheet_(sheet) {}

  // The sample with a tilt, where it lacks one and its pen is near.
  PenSample held(DeviceNumber device, PenSample pen, const TabletMapping& mapping);

 private:
  struct Followed {
    Timestamp last{};
    TrailingLean lean;
  };
  PenManner manner_;
  Extent sheet_;
  std::map<DeviceNumber, Followed> followed_;
};

}  // namespace fude
