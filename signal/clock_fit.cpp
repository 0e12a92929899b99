#include "signal/clock_fit.h"

#include <algorithm>
#include <cmath>

namespace fude {
namespace {

constexpr std::size_t young_readings = 64;
constexpr std::size_t settled_readings = 8;  // below these nothing is doubted but time that runs backwards
constexpr std::size_t kept_residuals = 1024;
constexpr std::size_t kept_doubtful = 1024;
constexpr std::size_t agreeing_readings = 4;
constexpr double outlier_spreads = 6;
constexpr double jump_spreads = 10;
constexpr double smallest_spread_s = 1e-6;       // stamps are often cut to microseconds
constexpr double gaussian_from_median = 1.4826;  // standard deviation over the median of |x|
constexpr double farthest_s = 4e9;               // whoever counts further does not count time
constexpr double gaussian_from_mean = 1.2533;    // and over its mean

double quantile(std::vector<double>& values, double share) {
  if (values.empty()) return 0;
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

ResidualQuantiles quantiles(std::vector<double> distances) {
  if (distances.empty()) return {};
  return {quantile(distances, 0.5), quantile(distances, 0.99),
          *std::max_element(distances.begin(), distances.end())};
}

// Times of any 64 bits: beyond 292 years apart they go round instead of overflowing.
double between(Timestamp from, Timestamp to) {
  return seconds(
      Duration(static_cast<std::int64_t>(static_cast<std::uint64_t>(to.time_since_epoch().count()) -
                                         static_cast<std::uint64_t>(from.time_since_epoch().count()))));
}

Timestamp after(Timestamp from, double s) {
  const auto ns = static_cast<std::uint64_t>(
      std::llround(std::isfinite(s) ? std::clamp(s, -farthest_s, farthest_s) * 1e9 : 0));
  return Timestamp(
      Duration(static_cast<std::int64_t>(static_cast<std::uint64_t>(from.time_since_epoch().count()) + ns)));
}

double biweight(double residual, double spread) {
  const double u = residual / (outlier_spreads * spread);
  return std::abs(u) < 1 ? (1 - u * u) * (1 - u * u) : 0;
}

struct Point {
  double tick;
  double host_s;
};

struct RobustLine {
  double offset_s = 0;
  double slope = 0;
  double spread_s = smallest_spread_s;
};

// Medians first (half of the points may be wild), then Tukey's biweight from there.
RobustLine robust_line(const std::vector<Point>& points, std::optional<double> slope_without_any) {
  RobustLine line;
  std::vector<double> values;
  const std::size_t half = std::max<std::size_t>(1, points.size() / 2);
  for (std::size_t i = 0; i + half < points.size(); ++i)
    if (const double run = points[i + half].tick - points[i].tick; run > 0)
      values.push_back((points[i + half].host_s - points[i].host_s) / run);
  line.slope = values.empty() ? slope_without_any.value_or(0) : quantile(values, 0.5);
  const auto spread = [&] {
    values.clear();
    for (const Point& p : points) values.push_back(std::abs(p.host_s - line.offset_s - line.slope * p.tick));
    return std::max(smallest_spread_s, gaussian_from_median * quantile(values, 0.5));
  };
  values.clear();
  for (const Point& p : points) values.push_back(p.host_s - line.slope * p.tick);
  line.offset_s = quantile(values, 0.5);
  line.spread_s = spread();
  for (int pass = 0; pass < 12; ++pass) {
    double weight = 0, tick = 0, host = 0;
    for (const Point& p : points) {
      const double w = biweight(p.host_s - line.offset_s - line.slope * p.tick, line.spread_s);
      weight += w;
      tick += w * p.tick;
      host += w * p.host_s;
    }
    if (!(weight > 0)) break;
    tick /= weight;
    host /= weight;
    double tick_tick = 0, tick_host = 0;
    for (const Point& p : points) {
      const double w = biweight(p.host_s - line.offset_s - line.slope * p.tick, line.spread_s);
      tick_tick += w * (p.tick - tick) * (p.tick - tick);
      tick_host += w * (p.tick - tick) * (p.host_s - host);
    }
    if (tick_tick > 0) line.slope = tick_host / tick_tick;
    line.offset_s = host - line.slope * tick;
    line.spread_s = spread();
  }
  return line;
}

}  // namespace

std::int64_t ClockLine::ticks(std::uint64_t tick, Timestamp near) const {
  if (counter_bits >= 64) return static_cast<std::int64_t>(tick - first_tick);
  const std::uint64_t wrap = std::uint64_t{1} << counter_bits;
  const auto forward = static_cast<std::int64_t>((tick - first_tick) & (wrap - 1));
  if (!(tick_s > 0)) return forward;
  const double expected = between(offset, near) / tick_s;
  const double turns = std::round((expected - static_cast<double>(forward)) / static_cast<double>(wrap));
  if (!(std::abs(turns) < 0x1p62 / static_cast<double>(wrap))) return forward;
  return forward + static_cast<std::int64_t>(turns) * static_cast<std::int64_t>(wrap);
}

Timestamp ClockLine::host(std::uint64_t tick, Timestamp near) const {
  const double s = tick_s * static_cast<double>(ticks(tick, near));
  return std::abs(s) < farthest_s ? after(offset, s) : near;
}

std::optional<double> ClockLine::drift_ppm() const {
  if (!nominal_tick || !(*nominal_tick > 0) || !(tick_s > 0)) return std::nullopt;
  return (tick_s / *nominal_tick - 1) * 1e6;
}

double ClockFitter::jump_s() const {
  const double jump = std::max(seconds(options_.smallest_jump), jump_spreads * spread_s_);
  if (options_.clock.counter_bits >= 64) return jump;
  // A counter that wraps is never further off the line than half its turn.
  return std::min(jump,
                  line_.tick_s * static_cast<double>(std::uint64_t{1} << options_.clock.counter_bits) / 4);
}

bool ClockFitter::strange(const ClockReading& reading) const {
  if (line_.readings < settled_readings && !options_.clock.nominal_tick)
    return options_.clock.counter_bits >= 64 && reading.tick < young_.back().tick;
  return std::abs(between(line_.host(reading.tick, reading.host), reading.host)) > jump_s() ||
         std::abs(line_.tick_s * static_cast<double>(line_.ticks(reading.tick, reading.host))) > farthest_s;
}

bool ClockFitter::restarted() const {
  if (doubtful_.size() < agreeing_readings) return false;
  const ClockReading& first = doubtful_.front();
  if (line_.readings < settled_readings || !(line_.tick_s > 0)) return true;
  ClockLine anew = line_;
  anew.first_tick = first.tick;
  anew.offset = first.host;
  double low = 0, high = 0, run_s = 0;
  for (const ClockReading& d : doubtful_) {
    const double ticks_s = anew.tick_s * static_cast<double>(anew.ticks(d.tick, d.host));
    const double off = between(first.host, d.host) - ticks_s;
    low = std::min(low, off);
    high = std::max(high, off);
    run_s = ticks_s;
  }
  const double jump = jump_s();
  // Both clocks must have gone on: what had piled up while the host was busy comes all at once.
  return high - low < jump && std::min(run_s, between(first.host, doubtful_.back().host)) >= 2 * jump;
}

void ClockFitter::restart(std::span<const ClockReading> readings) {
  if (seen_ > 0) closed_.push_back(lines().back());
  const double tick_s = line_.tick_s;
  line_ = {};
  line_.first_reading = seen_ - (readings.size() - 1);
  line_.since = line_.offset = readings.front().host;
  line_.first_tick = readings.front().tick;
  line_.counter_bits = options_.clock.counter_bits;
  line_.nominal_tick = options_.clock.nominal_tick;
  line_.tick_s = options_.clock.nominal_tick ? *options_.clock.nominal_tick : tick_s;
  young_.clear();
  residuals_.clear();
  next_residual_ = 0;
  for (const ClockReading& reading : readings) {
    young_.push_back(reading);
    ++line_.readings;
    refit();
  }
}

// Fits the young line to all it has, and sets the sums that later readings move.
void ClockFitter::refit() {
  std::vector<Point> points;
  for (const ClockReading& y : young_)
    points.push_back({static_cast<double>(line_.ticks(y.tick, y.host)), between(line_.since, y.host)});
  const RobustLine fit = robust_line(points, line_.tick_s);
  line_.offset = after(line_.since, fit.offset_s);
  line_.tick_s = fit.slope;
  spread_s_ = fit.spread_s;
  weight_ = mean_tick_ = mean_host_s_ = tick_tick_ = tick_host_ = 0;
  residuals_.clear();
  line_.outliers = 0;
  for (const Point& p : points) {
    const double residual = p.host_s - fit.offset_s - fit.slope * p.tick;
    remember(residual);
    line_.outliers += std::abs(residual) > outlier_spreads * spread_s_;
    move_line(p.tick, p.host_s, residual);
  }
}

void ClockFitter::remember(double residual_s) {
  if (residuals_.size() < kept_residuals) {
    residuals_.push_back(std::abs(residual_s));
    return;
  }
  residuals_[next_residual_] = std::abs(residual_s);
  next_residual_ = (next_residual_ + 1) % kept_residuals;
}

// Weighted means and moments about them (West 1979).
void ClockFitter::move_line(double ticks, double host_s, double residual_s) {
  const double w = biweight(residual_s, spread_s_);
  if (!(w > 0)) return;
  weight_ += w;
  const double tick_step = ticks - mean_tick_;
  mean_tick_ += tick_step * w / weight_;
  mean_host_s_ += (host_s - mean_host_s_) * w / weight_;
  tick_host_ += w * tick_step * (host_s - mean_host_s_);
  tick_tick_ += w * tick_step * (ticks - mean_tick_);
}

FittedReading ClockFitter::add(const ClockReading& reading) {
  const auto answer = [&] {
    const Timestamp fitted = line_.host(reading.tick, reading.host);
    const double off = std::abs(between(fitted, reading.host));
    return FittedReading{closed_.size(), fitted,
                         off > outlier_spreads * std::max(spread_s_, smallest_spread_s)};
  };
  if (seen_ == 0) {
    restart({&reading, 1});
    ++seen_;
    return answer();
  }
  if (strange(reading)) {
    doubtful_.push_back(reading);
    if (doubtful_.size() > kept_doubtful) doubtful_.pop_front();
    if (restarted()) {
      restart(std::vector<ClockReading>(doubtful_.begin(), doubtful_.end()));
      doubtful_.clear();
      ++seen_;
      return answer();
    }
    ++seen_;
    ++line_.outliers;
    ++line_.readings;
    return {closed_.size(), line_.host(reading.tick, reading.host), true};
  }
  ++seen_;
  doubtful_.clear();
  ++line_.readings;
  if (young_.size() < young_readings) {
    young_.push_back(reading);
    refit();
    return answer();
  }
  const FittedReading before = answer();
  const double ticks = static_cast<double>(line_.ticks(reading.tick, reading.host));
  const double host_s = between(line_.since, reading.host);
  const double residual = between(before.fitted, reading.host);
  remember(residual);
  line_.outliers += before.outlier;
  move_line(ticks, host_s, residual);
  if (tick_tick_ > 0) line_.tick_s = tick_host_ / tick_tick_;
  line_.offset = after(line_.since, mean_host_s_ - line_.tick_s * mean_tick_);
  // A stream that grows restless widens the spread, one wild reading hardly does.
  const double distance = std::min(std::abs(residual), 3 * spread_s_) * gaussian_from_mean;
  spread_s_ = std::max(smallest_spread_s, spread_s_ + (distance - spread_s_) / 64);
  return {before.line, line_.host(reading.tick, reading.host), before.outlier};
}

std::vector<ClockLine> ClockFitter::lines() const {
  std::vector<ClockLine> all = closed_;
  if (seen_ == 0) return all;
  all.push_back(line_);
  all.back().residual_s = quantiles(residuals_);
  return all;
}

ClockFit fit_clock(std::span<const ClockReading> readings, const ClockFitOptions& options) {
  ClockFitter fitter(options);
  for (const ClockReading& reading : readings) fitter.add(reading);
  ClockFit fit{fitter.lines(), {}};
  fit.readings.reserve(readings.size());
  for (std::size_t i = 0; i < fit.lines.size(); ++i) {
    ClockLine& line = fit.lines[i];
    const std::size_t end = i + 1 < fit.lines.size() ? fit.lines[i + 1].first_reading : readings.size();
    const auto run = readings.subspan(line.first_reading, end - line.first_reading);
    std::vector<Point> points;
    for (const ClockReading& r : run)
      points.push_back({static_cast<double>(line.ticks(r.tick, r.host)), between(line.since, r.host)});
    const RobustLine robust = robust_line(points, line.tick_s);
    line.offset = after(line.since, robust.offset_s);
    line.tick_s = robust.slope;
    line.readings = run.size();
    line.outliers = 0;
    std::vector<double> distances;
    for (const ClockReading& r : run) {
      const Timestamp fitted = line.host(r.tick, r.host);
      distances.push_back(std::abs(between(fitted, r.host)));
      const bool outlier = distances.back() > outlier_spreads * robust.spread_s;
      line.outliers += outlier;
      fit.readings.push_back({i, fitted, outlier});
    }
    line.residual_s = quantiles(std::move(distances));
  }
  return fit;
}

}  // namespace fude
