#include "calibration/pen_presses.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <optional>

#include "calibration/report.h"
#include "signal/elementary.h"

namespace fude {
namespace {

constexpr Duration bounce = std::chrono::milliseconds(60);
constexpr Duration shortest = std::chrono::milliseconds(20);
constexpr std::size_t fewest_samples = 3;
constexpr Radians steepest_tilt = degrees(80);

std::optional<PenPress> press_of(const std::vector<PenSample>& contact) {
  if (contact.size() < fewest_samples) return std::nullopt;
  PenPress press;
  press.first = contact.front().time.host;
  press.last = contact.back().time.host;
  press.samples = contact.size();
  const Duration length = press.last - press.first;
  if (length < shortest) return std::nullopt;
  std::vector<PenSample> middle;
  for (const PenSample& s : contact)
    if (s.time.host - press.first >= length / 4 && press.last - s.time.host >= length / 4)
      middle.push_back(s);
  if (middle.empty()) middle = contact;

  const auto values = [&](const std::function<double(const PenSample&)>& of) {
    std::vector<double> all;
    for (const PenSample& s : middle) all.push_back(of(s));
    return all;
  };
  const auto x = values([](const PenSample& s) { return s.x_counts; });
  const auto y = values([](const PenSample& s) { return s.y_counts; });
  press.counts = {quantile(x, 0.5), quantile(y, 0.5)};
  press.wandered_counts = {quantile(x, 1) - quantile(x, 0), quantile(y, 1) - quantile(y, 0)};
  press.tells_tilt = middle.front().tilt_x && middle.front().tilt_y;
  press.lean = {quantile(values([](const PenSample& s) { return lean_of(s).x(); }), 0.5),
                quantile(values([](const PenSample& s) { return lean_of(s).y(); }), 0.5)};
  press.pressure = quantile(values([](const PenSample& s) { return s.pressure.value; }), 0.5);
  return press;
}

}  // namespace

Eigen::Vector2d lean_of(const PenSample& pen) {
  const auto slope = [](const std::optional<Radians>& tilt) {
    return tilt ? elementary::tangent(std::clamp(*tilt, -steepest_tilt, steepest_tilt).value) : 0.0;
  };
  return {slope(pen.tilt_x), slope(pen.tilt_y)};
}

// A pen that lies still may send nothing for long: only its lifting ends a press.
void PressListener::add(const PenSample& sample) {
  if (!std::isfinite(sample.x_counts) || !std::isfinite(sample.y_counts) ||
      !std::isfinite(sample.pressure.value))
    return;
  const Timestamp now = sample.time.host;
  if (!contact_.empty() && now < contact_.back().time.host) close();
  if (lifted_ && now - *lifted_ > bounce) close();
  if (sample.in_proximity && sample.in_contact) {
    contact_.push_back(sample);
    lifted_.reset();
  } else if (!contact_.empty() && !lifted_) {
    lifted_ = now;
  }
}

void PressListener::close() {
  if (const auto press = press_of(contact_)) presses_.push_back(*press);
  contact_.clear();
  lifted_.reset();
}

std::vector<PenPress> PressListener::all() const {
  std::vector<PenPress> with_last = presses_;
  if (const auto press = press_of(contact_)) with_last.push_back(*press);
  return with_last;
}

}  // namespace fude
