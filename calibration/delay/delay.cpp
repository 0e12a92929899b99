#include "calibration/delay/delay.h"

#include <algorithm>
#include <cmath>

namespace fude {
namespace {

constexpr double ms_per_s = 1e3;
constexpr double ppm = 1e6;
constexpr double widest_ms = 5;
constexpr double fair_ms = 1;
constexpr double enough_touches = 40;
constexpr double enough_s = 30;

void warn_of(const Witness& witness, CalibrationReport& report) {
  if (witness.unusable > 0)
    report.warnings.push_back(std::to_string(witness.unusable) + " of " + std::to_string(witness.seen) +
                              " samples of " + witness.name + " hold no numbers or were not valid");
  if (witness.backwards > 0)
    report.warnings.push_back(std::to_string(witness.backwards) + " samples of " + witness.name +
                              " came with times that go back; they were left out");
}

// Why the stream is of no use; empty where it is.
std::string unfit(const Witness& witness) {
  if (witness.seen == 0) return witness.name + " has no samples";
  if (witness.unusable == witness.seen)
    return "all samples of " + witness.name + " hold no numbers or are not valid";
  if (witness.restarted_s) return restart_in_words(witness.name, "at " + in_words(*witness.restarted_s));
  if (witness.frozen) return witness.name + " is frozen: all of its samples are the same";
  if (witness.shows_nothing()) {
    if (witness.lifts) return witness.name + " felt no touch: make 40 strokes";
    return witness.name + " shows neither touches nor motion";
  }
  return "";
}

void describe(CalibrationReport& report, const DelayEstimate& estimate) {
  report.detail("method", estimate.method);
  report.detail("offset_s", estimate.line.offset_s);
  report.detail("offset_ci95_s", estimate.offset_ci95_s);
  report.detail("drift_ppm", ppm * estimate.drift);
  report.detail("drift_ci95_ppm", ppm * estimate.drift_ci95);
  if (estimate.halves_apart_s) report.detail("halves_apart_ms", ms_per_s * *estimate.halves_apart_s);
  for (const Field& field : estimate.details) report.details.push_back(field);
  std::vector<double> times, offsets, intervals;
  for (const DelayMoment& moment : estimate.course) {
    times.push_back(moment.t_s);
    offsets.push_back(ms_per_s * moment.offset_s);
    intervals.push_back(ms_per_s * moment.ci95_s);
  }
  report.detail("course_t_s", times);
  report.detail("course_offset_ms", offsets);
  report.detail("course_ci95_ms", intervals);
}

}  // namespace

Fields to_fields(const DelayCalibration& delay) {
  Fields fields{{"streams", std::vector<std::string>{delay.a, delay.b}}, {"offset_s", delay.offset_s}};
  if (delay.drift_ppm) {
    fields.push_back({"drift_ppm", *delay.drift_ppm});
    fields.push_back({"reference_s", delay.reference_s});
  }
  return fields;
}

std::optional<DelayCalibration> delay_from(const Fields& fields) {
  const auto offset = numbers_in(fields, "offset_s");
  if (!offset || offset->size() != 1 || !std::isfinite(offset->front())) return std::nullopt;
  DelayCalibration delay;
  delay.offset_s = offset->front();
  for (const Field& field : fields)
    if (const auto* names = std::get_if<std::vector<std::string>>(&field.value);
        field.key == "streams" && names && names->size() == 2)
      delay.a = names->front(), delay.b = names->back();
  const auto drift = numbers_in(fields, "drift_ppm"), since = numbers_in(fields, "reference_s");
  if (drift && since && drift->size() == 1 && since->size() == 1) {
    delay.drift_ppm = drift->front();
    delay.reference_s = since->front();
  }
  return delay;
}

Progress DelayProcedure::add(DelaySide side, const Sample& sample) {
  (side == DelaySide::a ? a_ : b_).add(sample);
  Progress progress{.samples = a_.samples() + b_.samples()};
  const std::size_t touches = std::max(a_.touches(), b_.touches());
  const double together_s = std::min(a_.span_s(), b_.span_s());
  progress.covered = touches > 0 ? std::min(1.0, double(touches) / (2 * enough_touches))
                                 : std::min(1.0, together_s / enough_s);
  if (progress.covered < 1)
    progress.missing = touches > 0 ? "touch down again, now fast, now slowly" : "go on moving the brush";
  return progress;
}

Calibration<DelayCalibration> DelayProcedure::finish() const {
  const Witness a = a_.witness(), b = b_.witness();
  CalibrationReport report;
  report.procedure = "delay";
  report.unit = "ms";
  report.to_frame = "times of " + a.name;
  report.from_frame = "times of " + b.name;
  for (const Witness* witness : {&a, &b}) warn_of(*witness, report);
  for (const Witness* witness : {&a, &b})
    if (auto why = unfit(*witness); !why.empty()) return refusal(report, std::move(why));
  const DelaySearch search;
  if (a.begin_s() > b.end_s() + search.range_s || b.begin_s() > a.end_s() + search.range_s)
    return refusal(report, a.name + " and " + b.name + " never overlap in time");
  const auto found = delay_between(a, b, search);
  if (!found) return refusal(report, found.error());

  std::vector<double> residuals_ms;
  for (const double r : found->residuals_s) residuals_ms.push_back(ms_per_s * r);
  summarise(report, residuals_ms, 1);
  const double offset_ms = ms_per_s * found->line.offset_s, half_ms = ms_per_s * found->offset_ci95_s;
  report.ci95 = {offset_ms - half_ms, offset_ms + half_ms};
  if (found->held_out_rms_s) report.held_out_rms = ms_per_s * *found->held_out_rms_s;
  describe(report, *found);
  report.warnings.insert(report.warnings.end(), found->warnings.begin(), found->warnings.end());
  if (!(half_ms < widest_ms))
    return refusal(report, "the offset is known to " + in_words(half_ms, 1) +
                               " ms only: record longer, with strokes of more different speeds");
  if (half_ms > fair_ms)
    report.warnings.push_back("the offset is known to " + in_words(half_ms, 1) + " ms only");

  DelayCalibration delay{a.name, b.name, found->line.offset_s, std::nullopt, found->line.reference_s};
  if (found->line.drift != 0) {
    delay.drift_ppm = ppm * found->line.drift;
    report.warnings.push_back("the clocks drift by " + in_words(*delay.drift_ppm, 1) +
                              " ppm: the offset counts in this session, at " +
                              in_words(delay.reference_s, 1) + " s");
  }
  report.accepted = true;
  report.reason = b.name + " is " + in_words(std::abs(offset_ms)) + " ms " +
                  (offset_ms < 0 ? "later" : "earlier") + " than " + a.name + ", ± " + in_words(half_ms) +
                  " ms (95 %), by " + found->method;
  return Calibrated<DelayCalibration>{delay, report};
}

}  // namespace fude
