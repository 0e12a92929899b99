#include "calibration/delay/witness.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "calibration/report.h"

namespace fude {
namespace {

constexpr double restart_s = 0.1;
constexpr double shortest_touch_s = 0.03;
constexpr double longest_turn_gap_s = 0.1;
constexpr double apart_s = 0.1;  // of two jolts
constexpr double unusual = 8;
constexpr double mm_per_m = 1e3;

// A gap before a touch is the silence of a pen that rests or is away: had it touched, it would have said so
// at the next scan.
std::vector<Touch> without_chatter(std::vector<Touch> touches, double interval_s) {
  std::vector<Touch> kept;
  for (Touch& touch : touches) {
    touch.early_s = std::min(touch.early_s, interval_s);
    if (!kept.empty() && touch.t_s - kept.back().t_s < shortest_touch_s)
      kept.pop_back();
    else
      kept.push_back(touch);
  }
  return kept;
}

std::vector<Touch> jolts(const Series& force) {
  std::vector<Touch> touches;
  std::vector<double> changes;
  for (std::size_t i = 1; i < force.size(); ++i)
    changes.push_back((force.values[i] - force.values[i - 1]).norm());
  const double least = unusual * quantile(changes, 0.5);
  if (!(least > 0)) return touches;
  const double interval_s = force.interval_s();
  std::size_t strongest = 0;
  for (std::size_t i = 0; i < changes.size(); ++i) {
    if (changes[i] <= least) continue;
    const double t_s = force.t_s[i + 1];
    if (!touches.empty() && t_s - touches.back().t_s < apart_s) {
      if (changes[i] <= changes[strongest]) continue;
      touches.pop_back();
    }
    strongest = i;
    touches.push_back({t_s, std::min(t_s - force.t_s[i], interval_s), true});
  }
  return touches;
}

bool all_the_same(const Series& series) {
  return series.size() > 1 && std::all_of(series.values.begin(), series.values.end(),
                                          [&](const auto& v) { return v == series.values.front(); });
}

}  // namespace

double Witness::begin_s() const {
  double begin = INFINITY;
  for (const Series* s : {&path, &turn_rate})
    if (!s->empty()) begin = std::min(begin, s->t_s.front());
  if (!touches.empty()) begin = std::min(begin, touches.front().t_s);
  return std::isfinite(begin) ? begin : 0;
}

double Witness::end_s() const {
  double end = -INFINITY;
  for (const Series* s : {&path, &turn_rate})
    if (!s->empty()) end = std::max(end, s->t_s.back());
  if (!touches.empty()) end = std::max(end, touches.back().t_s);
  return std::isfinite(end) ? end : 0;
}

void WitnessReader::see_point(const Eigen::Vector3d& point_m, double t_s) {
  witness_.path.add(t_s, surface_ ? Eigen::Vector3d(on_paper(*surface_, point_m) / mm_per_m) : point_m);
  witness_.levelled = surface_.has_value();
}

void WitnessReader::see(const PoseSample& sample, double t_s) {
  const Eigen::Quaterniond& turn = sample.tracker_from_tool.rotation;
  see_point(sample.tracker_from_tool * tip_m_.value_or(Eigen::Vector3d::Zero()), t_s);
  if (last_turn_ && t_s - last_turn_->first < longest_turn_gap_s) {
    Eigen::Quaterniond between = last_turn_->second.conjugate() * turn;
    if (between.w() < 0) between.coeffs() *= -1;
    const Eigen::AngleAxisd turned(between.normalized());
    const double step_s = t_s - last_turn_->first;
    witness_.turn_rate.add(last_turn_->first + step_s / 2, turned.angle() / step_s * turned.axis());
  }
  last_turn_ = {t_s, turn};
}

void WitnessReader::see(const ImuSample& sample, double t_s) {
  witness_.turn_rate.add(t_s, sample.turn_rate_radps);
  force_.add(t_s, sample.specific_force_mps2);
}

void WitnessReader::see_contact(bool contact, bool after_gap, double t_s) {
  if (touching_ && !after_gap && contact != *touching_ && last_s_)
    witness_.touches.push_back({t_s, t_s - *last_s_, contact});
  touching_ = contact;
  witness_.lifts = true;
  contact_.add(t_s, {contact ? 1.0 : 0.0, 0, 0});
}

// Times that go back a little are those of samples on two ways; by more, another clock's.
bool WitnessReader::comes_later(double t_s) {
  if (!last_s_ || t_s > *last_s_) return true;
  if (t_s < *last_s_ - restart_s && !witness_.restarted_s) witness_.restarted_s = *last_s_;
  ++witness_.backwards;
  return false;
}

// False: the sample cannot be used.
struct WitnessReader::Reading {
  WitnessReader& reader;
  bool operator()(const PoseSample& s) {
    const auto& pose = s.tracker_from_tool;
    const bool rotation = std::abs(pose.rotation.norm() - 1) < 1e-2;
    return at(s.time, s.valid && rotation && pose.translation.allFinite(),
              [&](double t) { reader.see(s, t); });
  }
  bool operator()(const PositionSample& s) {
    return at(s.time, s.valid && s.tracker_from_marker_m.allFinite(),
              [&](double t) { reader.see_point(s.tracker_from_marker_m, t); });
  }
  bool operator()(const HapticSample& s) {
    return at(s.time, s.homed && s.position_m.allFinite(),
              [&](double t) { reader.see_point(s.position_m, t); });
  }
  bool operator()(const ImuSample& s) {
    return at(s.time, s.valid && s.turn_rate_radps.allFinite() && s.specific_force_mps2.allFinite(),
              [&](double t) { reader.see(s, t); });
  }
  bool operator()(const PenSample& s) {
    return at(s.time, std::isfinite(s.x_counts) && std::isfinite(s.y_counts), [&](double t) {
      reader.see_contact(s.in_contact, s.after_gap, t);
      reader.witness_.flat = true;
      if (s.in_proximity || s.in_contact) reader.witness_.path.add(t, {s.x_counts, s.y_counts, 0});
    });
  }
  bool operator()(const TouchSample& s) {
    return at(s.time, !s.palm, [&](double t) { reader.see_contact(s.down, s.after_gap, t); });
  }
  template <class Other>
  bool operator()(const Other&) {
    return true;
  }
  template <class See>
  bool at(const SampleTime& time, bool sound, See see) {
    const double t_s = seconds(time.host.time_since_epoch());
    if (!sound) return false;
    if (reader.comes_later(t_s)) {
      see(t_s);
      reader.last_s_ = t_s;
    }
    return true;
  }
};

void WitnessReader::add(const Sample& sample) {
  ++witness_.seen;
  if (!std::visit(Reading{*this}, sample)) ++witness_.unusable;
}

void WitnessReader::forget_before(double t_s) {
  for (Series* series : {&witness_.path, &witness_.turn_rate, &force_, &contact_}) {
    const auto first = std::lower_bound(series->t_s.begin(), series->t_s.end(), t_s) - series->t_s.begin();
    series->t_s.erase(series->t_s.begin(), series->t_s.begin() + first);
    series->values.erase(series->values.begin(), series->values.begin() + first);
  }
  std::erase_if(witness_.touches, [&](const Touch& touch) { return touch.t_s < t_s; });
}

void WitnessReader::begin_anew() {
  WitnessReader anew(witness_.name);
  anew.know(tip_m_, std::move(surface_));
  *this = std::move(anew);
}

Witness WitnessReader::witness() const {
  Witness result = witness_;
  result.frozen = all_the_same(result.path) && (result.turn_rate.empty() || all_the_same(result.turn_rate)) &&
                  result.touches.empty();
  if (!force_.empty()) {
    result.frozen = all_the_same(force_) && all_the_same(result.turn_rate);
    result.touches = jolts(force_);
  } else {
    result.touches = without_chatter(std::move(result.touches), contact_.interval_s());
  }
  return result;
}

}  // namespace fude
