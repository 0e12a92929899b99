// What a calibration says of itself, and how its results are kept: one form for every procedure, so that
// the terminal, the window and the file need to know none of them.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>
#include <variant>
#include <vector>

namespace fude {

// A named value; its key ends in its unit where it has one: tip_m, lean_rad.
using FieldValue = std::variant<double, std::string, std::vector<double>, std::vector<std::string>>;
struct Field {
  std::string key;
  FieldValue value;
};
using Fields = std::vector<Field>;

// The numbers under `key`; none where there is no such key or it holds no numbers.
std::optional<std::vector<double>> numbers_in(const Fields& fields, std::string_view key);
std::optional<std::string> text_in(const Fields& fields, std::string_view key);

struct CalibrationReport {
  std::string procedure;  // "pivot", "surface" …
  std::string to_frame;   // the result takes points of from_frame to to_frame
  std::string from_frame;
  std::string unit = "mm";  // of everything down to ci95
  double rms = 0;           // of distances, over the samples that were used
  double rms_per_coordinate = 0;
  double p95 = 0;
  double max = 0;
  std::optional<double> held_out_rms;         // of samples that the fit did not see
  std::size_t n = 0;                          // samples used
  std::optional<std::array<double, 2>> ci95;  // of a value; of a point [0, r]: the truth lies within r of it
  std::optional<double> condition;            // of the equations; 1 is best
  bool accepted = false;
  std::string reason;  // why, in words a person can act on
  std::vector<std::string> warnings;
  Fields details;  // what only this procedure can say

  // What the calibration was made from; the rig's to fill.
  std::string date;                  // UTC, ISO 8601
  std::vector<std::string> devices;  // "vendor:product:serial" each
  std::string tool;                  // of a tracker, where it holds for that one alone
  std::string reference;             // the tool whose frame stands for the tracker's
  std::string session;               // the input's identity

  void detail(std::string key, FieldValue value) { details.push_back({std::move(key), std::move(value)}); }
};

// Fills rms, rms_per_coordinate, p95, max and n from the lengths of residuals of that many coordinates.
void summarise(CalibrationReport& report, std::span<const double> lengths, int coordinates);

double root_mean_square(std::span<const double> values);
// Share 0 to 1 of the values, in order; the nearest one. 0 of nothing.
double quantile(std::vector<double> values, double share);

// A value that passed its own thresholds. There is no way to one from a calibration that was refused: that
// is only a report.
template <class T>
struct Calibrated {
  T value;
  CalibrationReport report;
};
template <class T>
using Calibration = tl::expected<Calibrated<T>, CalibrationReport>;

inline tl::unexpected<CalibrationReport> refusal(CalibrationReport report, std::string reason) {
  report.accepted = false;
  report.reason = std::move(reason);
  return tl::unexpected<CalibrationReport>(std::move(report));
}

// How far a procedure has come. `covered` reaches 1 when finish() has what it needs; `missing` then is empty.
struct Progress {
  std::size_t samples = 0;  // that could be used
  double covered = 0;
  std::string missing;  // what to do next: "lean it to the sides as well"
};

// "12.3": a number in a sentence.
std::string in_words(double value, int decimals = 2);

}  // namespace fude
