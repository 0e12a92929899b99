#include "rig/pen_manner.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <utility>

#include "signal/elementary.h"

namespace fude {
namespace {

constexpr double degree = std::numbers::pi / 180;

// A hand writes some 30 cm from its elbow, which rests to the side of the sheet's middle and below it.
constexpr double elbow_right_mm = 140;
constexpr double elbow_below_mm = 260;
constexpr double lean_rad = 20 * degree;
constexpr double lean_rad_per_mm = 0.06 * degree;  // of reach
constexpr double lean_rad_by_pressure = 8 * degree;
constexpr double least_lean_rad = 5 * degree;
constexpr double most_lean_rad = 45 * degree;

constexpr double trailing_rad = 30 * degree;  // of a brush that is drawn fast
constexpr double slow_mm_s = 10;              // at which it leans two thirds as much
constexpr double smoothing_s = 0.12;
constexpr double part_s = 0.002;
constexpr double gap_s = 0.25;

constexpr double steepest_deg = 80;

constexpr std::array<std::pair<HoldingManner, const char*>, 5> words{{{HoldingManner::upright, "upright"},
                                                                      {HoldingManner::hand, "hand"},
                                                                      {HoldingManner::left_hand, "left-hand"},
                                                                      {HoldingManner::travel, "travel"},
                                                                      {HoldingManner::fixed, "fixed"}}};

bool read_degrees(const char*& from, const char* end, double& value) {
  const auto [next, error] = std::from_chars(from, end, value);
  from = next;
  return error == std::errc{} && std::isfinite(value) && std::abs(value) <= steepest_deg;
}

}  // namespace

Result<PenManner> parse_manner(const std::string& text) {
  for (const auto& [kind, word] : words)
    if (text == word)
      return kind == HoldingManner::fixed ? PenManner{kind, degrees(20), degrees(15)}
                                          : PenManner{kind, {}, {}};
  const std::string fixed = "fixed:";
  if (text.starts_with(fixed)) {
    const char* at = text.data() + fixed.size();
    const char* end = text.data() + text.size();
    double right = 0;
    double towards = 0;
    if (read_degrees(at, end, right) && at != end && *at++ == ',' && read_degrees(at, end, towards) &&
        at == end)
      return PenManner{HoldingManner::fixed, degrees(right), degrees(towards)};
  }
  return failure(
      Fault::usage,
      "--manner takes upright, hand, left-hand, travel, fixed or fixed:RIGHT,TOWARDS (degrees up to "
      "80); '" +
          text + "' is none of them");
}

std::string as_text(const PenManner& manner) {
  std::string text;
  for (const auto& [kind, word] : words)
    if (kind == manner.kind) text = word;
  if (manner.kind != HoldingManner::fixed) return text;
  for (const auto& [mark, lean] : {std::pair(':', manner.right), std::pair(',', manner.towards)}) {
    std::array<char, 32> number{};
    const auto end = std::to_chars(number.data(), number.data() + number.size(), in_degrees(lean)).ptr;
    text += mark + std::string(number.data(), end);
  }
  return text;
}

Lean lean_of_hand(const Eigen::Vector2d& nib_mm, double pressure, Extent sheet, bool left_handed) {
  const Eigen::Vector2d middle(0.5 * sheet.width.value, 0.5 * sheet.height.value);
  const Eigen::Vector2d elbow =
      middle + Eigen::Vector2d(left_handed ? -elbow_right_mm : elbow_right_mm, -elbow_below_mm);
  const Eigen::Vector2d to_elbow = elbow - nib_mm;
  const double reach = elementary::square_root(to_elbow.squaredNorm());
  const double usual = elementary::square_root((elbow - middle).squaredNorm());
  if (reach < 1) return Lean::Zero();
  const double lean = std::clamp(
      lean_rad + lean_rad_per_mm * (reach - usual) + lean_rad_by_pressure * std::clamp(pressure, 0.0, 1.0),
      least_lean_rad, most_lean_rad);
  return elementary::tangent(lean) / reach * to_elbow;
}

const Lean& TrailingLean::follow(const Eigen::Vector2d& nib_mm, double seconds) {
  const Eigen::Vector2d from = std::exchange(nib_mm_, nib_mm);
  if (!std::exchange(placed_, true) || !(seconds > 0 && seconds <= gap_s)) {
    if (seconds > gap_s) velocity_.setZero();
    return lean_;
  }
  const Eigen::Vector2d going = (nib_mm - from) / seconds;
  const int parts = std::max(1, static_cast<int>(std::ceil(seconds / part_s - 1e-6)));
  const double part = seconds / parts;
  const double smoothed = 1 - elementary::exponential(-part / smoothing_s);
  const double most = elementary::tangent(trailing_rad);
  for (int k = 0; k < parts; ++k) {
    velocity_ += smoothed * (going - velocity_);
    const double speed = elementary::square_root(velocity_.squaredNorm());
    const double drawn = speed / (speed + slow_mm_s);  // where it rests the lean stays
    const double turned = 1 - elementary::exponential(-drawn * part / smoothing_s);
    const double fast = elementary::square_root(speed * speed + slow_mm_s * slow_mm_s);
    lean_ += turned * (most / fast * velocity_ - lean_);
  }
  return lean_;
}

PenSample HeldPens::held(DeviceNumber device, PenSample pen, const TabletMapping& mapping) {
  if ((pen.tilt_x && pen.tilt_y) || manner_.kind == HoldingManner::upright || !pen.in_proximity) return pen;
  if (manner_.kind == HoldingManner::fixed) {
    pen.tilt_x = manner_.right;
    pen.tilt_y = manner_.towards;
    return pen;
  }
  const Eigen::Vector2d nib = nib_on_paper(pen, mapping);
  Lean lean = Lean::Zero();
  if (manner_.kind == HoldingManner::travel) {
    Followed& followed = followed_[device];
    const Timestamp before = std::exchange(followed.last, pen.time.host);
    lean = followed.lean.follow(nib, pen.after_gap ? 2 * gap_s : seconds(pen.time.host - before));
  } else {
    lean = lean_of_hand(nib, pen.pressure.value, sheet_, manner_.kind == HoldingManner::left_hand);
  }
  // The tablet may lie turned on the sheet, and its y grows towards the painter.
  const auto [sine, cosine] = elementary::sine_cosine(mapping.turn.value);
  pen.tilt_x = Radians(elementary::arctangent(cosine * lean.x() + sine * lean.y()));
  pen.tilt_y = Radians(elementary::arctangent(-(-sine * lean.x() + cosine * lean.y())));
  return pen;
}

}  // namespace fude
