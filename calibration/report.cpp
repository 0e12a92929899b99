#include "calibration/report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace fude {
namespace {

const FieldValue* find(const Fields& fields, std::string_view key) {
  for (const Field& field : fields)
    if (field.key == key) return &field.value;
  return nullptr;
}

}  // namespace

std::optional<std::vector<double>> numbers_in(const Fields& fields, std::string_view key) {
  const FieldValue* value = find(fields, key);
  if (value == nullptr) return std::nullopt;
  if (const auto* number = std::get_if<double>(value)) return std::vector{*number};
  if (const auto* list = std::get_if<std::vector<double>>(value)) return *list;
  return std::nullopt;
}

std::optional<std::string> text_in(const Fields& fields, std::string_view key) {
  const FieldValue* value = find(fields, key);
  const auto* text = value != nullptr ? std::get_if<std::string>(value) : nullptr;
  return text != nullptr ? std::optional(*text) : std::nullopt;
}

double root_mean_square(std::span<const double> values) {
  double sum = 0;
  for (const double v : values) sum += v * v;
  return values.empty() ? 0 : std::sqrt(sum / double(values.size()));
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  const auto at = static_cast<std::ptrdiff_t>(std::lround(share * double(values.size() - 1)));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

void summarise(CalibrationReport& report, std::span<const double> lengths, int coordinates) {
  report.n = lengths.size();
  report.rms = root_mean_square(lengths);
  report.rms_per_coordinate = report.rms / std::sqrt(double(coordinates));
  report.p95 = quantile({lengths.begin(), lengths.end()}, 0.95);
  report.max = lengths.empty() ? 0 : *std::max_element(lengths.begin(), lengths.end());
}

std::string in_words(double value, int decimals) {
  char text[48];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  return text;
}

}  // namespace fude
