#include "calibration/pressure.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace fude {
namespace {

constexpr double newtons_per_gram = 9.80665e-3;
constexpr double saturated = 0.999;  // of the device's range
constexpr double same_level = 0.01;  // presses nearer than this are one level
constexpr std::size_t fewest_levels = 6;
constexpr double most_disorder = 0.1;  // of the largest force
constexpr double heaviest_grams = 5000, lightest_range_grams = 20;
constexpr Duration reading = std::chrono::milliseconds(250);  // to either side of a time on the scale

struct Level {
  double pressure = 0;
  double force_n = 0;
  double presses = 1;
};

Level together(const Level& a, const Level& b) {
  const double n = a.presses + b.presses;
  return {(a.presses * a.pressure + b.presses * b.pressure) / n,
          (a.presses * a.force_n + b.presses * b.force_n) / n, n};
}

// Neighbours in pressure that the pen does not tell apart, or whose forces stand in the wrong order, become
// one: the isotonic regression (Ayer et al. 1955), whose flat parts are one level each.
std::vector<Level> levels_of(std::vector<Level> presses) {
  std::ranges::sort(presses, {}, &Level::pressure);
  std::vector<Level> levels;
  for (Level level : presses) {
    while (!levels.empty() &&
           (level.pressure - levels.back().pressure < same_level || level.force_n <= levels.back().force_n)) {
      level = together(levels.back(), level);
      levels.pop_back();
    }
    levels.push_back(level);
  }
  return levels;
}

// The slopes at the ends of an interval that keep its cubic monotone.
double inner_slope(double h0, double d0, double h1, double d1) {
  if (d0 <= 0 || d1 <= 0) return 0;
  const double w0 = 2 * h1 + h0, w1 = h1 + 2 * h0;
  return (w0 + w1) / (w0 / d0 + w1 / d1);
}
double end_slope(double h0, double d0, double h1, double d1) {
  return std::clamp(((2 * h0 + h1) * d0 - h0 * d1) / (h0 + h1), 0.0, 3 * d0);
}

double slope_at(const PressureCurve& c, std::size_t k) {
  const std::size_t last = c.pressure.size() - 1;
  const auto h = [&](std::size_t i) { return c.pressure[i + 1] - c.pressure[i]; };
  const auto d = [&](std::size_t i) { return (c.force_n[i + 1] - c.force_n[i]) / h(i); };
  if (last == 1) return d(0);
  if (k == 0) return end_slope(h(0), d(0), h(1), d(1));
  if (k == last) return end_slope(h(last - 1), d(last - 1), h(last - 2), d(last - 2));
  return inner_slope(h(k - 1), d(k - 1), h(k), d(k));
}

double in_interval(const PressureCurve& c, std::size_t k, double pressure) {
  const double h = c.pressure[k + 1] - c.pressure[k];
  const double t = (pressure - c.pressure[k]) / h;
  const double rise = c.force_n[k + 1] - c.force_n[k];
  const double m0 = h * slope_at(c, k), m1 = h * slope_at(c, k + 1);
  return c.force_n[k] + t * (m0 + t * (3 * rise - 2 * m0 - m1 + t * (m0 + m1 - 2 * rise)));
}

// Through the levels, led on straight to where the pen begins to feel and to where it says 1, within what was
// pressed there.
PressureCurve curve_through(const std::vector<Level>& levels, double unfelt_n,
                            std::optional<double> saturated_n) {
  PressureCurve curve;
  const Level &first = levels[0], &second = levels[1];
  if (first.pressure > 0) {
    const double slope = (second.force_n - first.force_n) / (second.pressure - first.pressure);
    curve.pressure.push_back(0);
    curve.force_n.push_back(std::clamp(first.force_n - slope * first.pressure,
                                       std::min(std::max(0.0, unfelt_n), first.force_n), first.force_n));
  }
  for (const Level& level : levels) {
    curve.pressure.push_back(level.pressure);
    curve.force_n.push_back(level.force_n);
  }
  if (!saturated_n) return curve;
  const Level &last = levels.back(), &before = levels[levels.size() - 2];
  const double slope = (last.force_n - before.force_n) / (last.pressure - before.pressure);
  const double top =
      std::max(last.force_n, std::min(last.force_n + slope * (1 - last.pressure), *saturated_n));
  curve.pressure.push_back(1);
  curve.force_n.push_back(top);
  curve.saturation_n = top;
  return curve;
}

// Levels between others, each foretold by the curve without it.
std::vector<double> left_out(const std::vector<Level>& levels) {
  std::vector<double> errors;
  for (std::size_t i = 1; i + 1 < levels.size(); ++i) {
    std::vector<Level> others = levels;
    others.erase(others.begin() + std::ptrdiff_t(i));
    const PressureCurve curve = curve_through(others, 0, std::nullopt);
    errors.push_back(std::abs(force_n(curve, Fraction(levels[i].pressure)) - levels[i].force_n));
  }
  return errors;
}

// The largest distance of a press from the isotonic regression.
double disorder(const std::vector<Level>& presses) {
  const std::vector<Level> levels = levels_of(presses);
  double most = 0;
  for (const Level& press : presses) {
    const auto nearest = std::ranges::min_element(
        levels, {}, [&](const Level& l) { return std::abs(l.pressure - press.pressure); });
    most = std::max(most, levels.size() < 2 ? std::abs(nearest->force_n - press.force_n)
                                            : std::abs(force_n(curve_through(levels, 0, std::nullopt),
                                                               Fraction(press.pressure)) -
                                                       press.force_n));
  }
  return most;
}

std::optional<std::string> wrong_with(const std::vector<Weighing>& weighings) {
  double heaviest = 0;
  for (const Weighing& w : weighings) {
    if (!std::isfinite(w.grams) || w.grams < 0) return "a weight is no number of grams";
    heaviest = std::max(heaviest, w.grams);
  }
  if (heaviest > heaviest_grams)
    return in_words(heaviest, 0) + " g is more than a pen is pressed with: give grams";
  if (!weighings.empty() && heaviest < lightest_range_grams)
    return "the heaviest press weighs " + in_words(heaviest, 1) +
           " g: give grams, and press up to a few hundred";
  return std::nullopt;
}

// The pen's pressure when the scale was read; what it said last where it lay still and said nothing.
double pressure_near(const std::vector<PenSample>& heard, Timestamp at) {
  std::vector<double> near;
  double last = 0;
  for (const PenSample& s : heard) {
    const double pressure = s.in_proximity && s.in_contact ? s.pressure.value : 0;
    if (s.time.host <= at) last = pressure;
    if (s.time.host >= at - reading && s.time.host <= at + reading) near.push_back(pressure);
  }
  return near.empty() ? last : quantile(near, 0.5);
}

}  // namespace

Fields to_fields(const PressureCurve& curve) {
  Fields fields{
      {"pressure", curve.pressure}, {"force_n", curve.force_n}, {"threshold_n", curve.force_n.front()}};
  if (curve.saturation_n) fields.push_back({"saturation_n", *curve.saturation_n});
  return fields;
}

std::optional<PressureCurve> pressure_curve_from(const Fields& fields) {
  const auto pressure = numbers_in(fields, "pressure"), force = numbers_in(fields, "force_n"),
             saturation = numbers_in(fields, "saturation_n");
  if (!pressure || !force || pressure->size() != force->size() || pressure->size() < 2) return std::nullopt;
  for (std::size_t i = 0; i < pressure->size(); ++i) {
    if (!std::isfinite((*pressure)[i]) || !std::isfinite((*force)[i])) return std::nullopt;
    if (i > 0 && (!((*pressure)[i] > (*pressure)[i - 1]) || (*force)[i] < (*force)[i - 1]))
      return std::nullopt;
  }
  PressureCurve curve{*pressure, *force, std::nullopt};
  if (saturation && !saturation->empty()) curve.saturation_n = saturation->front();
  return curve;
}

double force_n(const PressureCurve& curve, Fraction pressure) {
  const double p = std::clamp(pressure.value, 0.0, 1.0);
  if (p <= curve.pressure.front()) return curve.force_n.front();
  const std::size_t last = curve.pressure.size() - 1;
  if (p >= curve.pressure.back())
    return curve.force_n.back() + slope_at(curve, last) * (p - curve.pressure.back());
  const auto above = std::ranges::upper_bound(curve.pressure, p);
  return in_interval(curve, std::size_t(above - curve.pressure.begin()) - 1, p);
}

Fraction pressure_at(const PressureCurve& curve, double force) {
  if (!(force > curve.force_n.front())) return Fraction(0);
  if (force >= force_n(curve, Fraction(1))) return Fraction(1);
  double low = 0, high = 1;
  for (int halving = 0; halving < 52; ++halving) {
    const double middle = 0.5 * (low + high);
    (force_n(curve, Fraction(middle)) < force ? low : high) = middle;
  }
  return Fraction(0.5 * (low + high));
}

Progress PressureProcedure::add(const PenSample& sample) {
  ++samples_;
  listener_.add(sample);
  if (!weighings_.empty() && weighings_.front().at && std::isfinite(sample.pressure.value))
    heard_.push_back(sample);
  const std::size_t done = std::min(listener_.presses().size(), weighings_.size());
  if (done == weighings_.size()) return {samples_, 1, ""};
  return {samples_, double(done) / double(weighings_.size()),
          "press " + std::to_string(done + 1) + " of " + std::to_string(weighings_.size()) + ", " +
              in_words(weighings_[done].grams, 0) + " g"};
}

Calibration<PressureCurve> PressureProcedure::finish() const {
  CalibrationReport report;
  report.procedure = "pressure";
  report.to_frame = "force";
  report.from_frame = "pressure";
  report.unit = "N";
  report.n = weighings_.size();
  if (auto wrong = wrong_with(weighings_)) return refusal(report, *wrong);
  const std::vector<PenPress> presses = listener_.all();
  const bool timed = !weighings_.empty() && weighings_.front().at.has_value();
  if (!timed && presses.size() != weighings_.size())
    return refusal(report,
                   std::to_string(presses.size()) + " presses for " + std::to_string(weighings_.size()) +
                       " weights: press once for each, in their order, and lift between; a weight that "
                       "the pen does not feel is none");

  std::vector<Level> felt;
  double unfelt_n = 0;
  std::optional<double> saturated_n;
  for (std::size_t i = 0; i < weighings_.size(); ++i) {
    const double force = newtons_per_gram * weighings_[i].grams;
    const double pressure = timed ? pressure_near(heard_, *weighings_[i].at) : presses[i].pressure;
    if (pressure <= 0)
      unfelt_n = std::max(unfelt_n, force);
    else if (pressure >= saturated)
      saturated_n = std::min(saturated_n.value_or(force), force);
    else
      felt.push_back({pressure, force});
  }
  const std::vector<Level> levels = levels_of(felt);
  double largest_n = 0;
  for (const Level& press : felt) largest_n = std::max(largest_n, press.force_n);
  if (felt.size() >= fewest_levels) {
    const auto [low, high] = std::ranges::minmax(felt, {}, &Level::pressure);
    if (high.pressure - low.pressure < same_level)
      return refusal(report,
                     "the pressure stays at " + in_words(low.pressure) +
                         " whatever the weight: this pen's pressure is frozen, or was not on the scale");
    if (const double off = disorder(felt); off > most_disorder * largest_n) {
      std::vector<Level> turned = felt;
      for (std::size_t i = 0; i < felt.size(); ++i) turned[i].force_n = felt[felt.size() - 1 - i].force_n;
      const bool reversed = disorder(turned) < most_disorder * largest_n;
      return refusal(report, "more weight did not give more pressure (" + in_words(off) + " N against it): " +
                                 (reversed ? "the weights fit the presses in the reverse order"
                                           : "are the weights in the order of the presses?"));
    }
  }
  if (levels.size() < fewest_levels)
    return refusal(report, "only " + std::to_string(levels.size()) +
                               " levels between nothing and full pressure, " + std::to_string(fewest_levels) +
                               " are the fewest: press with more different weights");

  const PressureCurve curve = curve_through(levels, unfelt_n, saturated_n);
  std::vector<double> residuals;
  for (const Level& press : felt)
    residuals.push_back(std::abs(force_n(curve, Fraction(press.pressure)) - press.force_n));
  summarise(report, residuals, 1);
  const std::vector<double> foretold = left_out(levels);
  report.held_out_rms = root_mean_square(foretold);
  report.ci95 = {0, 1.96 * std::max(*report.held_out_rms, report.rms)};
  report.detail("levels", double(levels.size()));
  report.detail("threshold_between_n", std::vector{unfelt_n, levels.front().force_n});
  if (saturated_n)
    report.detail("saturation_between_n", std::vector{levels.back().force_n, *saturated_n});
  else
    report.warnings.push_back("no press was hard enough for the full pressure: above " +
                              in_words(levels.back().force_n) + " N the curve goes on straight");
  if (levels.front().pressure > 0.15)
    report.warnings.push_back("the lightest press already gave " + in_words(levels.front().pressure) +
                              " of the pressure: press more lightly too, to find where it begins");
  if (*report.held_out_rms > most_disorder * largest_n)
    report.warnings.push_back("a level that is left out is foretold " + in_words(*report.held_out_rms) +
                              " N off: press with more weights between");
  report.accepted = true;
  report.reason = "felt from " + in_words(curve.force_n.front()) + " N" +
                  (curve.saturation_n ? ", full at " + in_words(*curve.saturation_n) + " N" : "") +
                  "; between, within " + in_words((*report.ci95)[1]) + " N (95 %)";
  return Calibrated<PressureCurve>{curve, report};
}

}  // namespace fude
