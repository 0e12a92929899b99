#include "capture/import/csv_rows.h"

#include <algorithm>
#include <cmath>

#include "capture/import/text_fields.h"

namespace fude {
namespace {

constexpr std::size_t most_columns = 4096;

void split(std::string_view line, std::vector<std::string_view>& fields) {
  fields.clear();
  while (fields.size() < most_columns) {
    const std::size_t comma = line.find(',');
    std::string_view field = line.substr(0, comma);
    const std::size_t begin = field.find_first_not_of(" \t");
    field = begin == std::string_view::npos ? std::string_view{} : field.substr(begin);
    field = field.substr(0, field.find_last_not_of(" \t") + 1);
    if (field.size() >= 2 && field.front() == '"' && field.back() == '"')
      field = field.substr(1, field.size() - 2);
    fields.push_back(field);
    if (comma == std::string_view::npos) return;
    line.remove_prefix(comma + 1);
  }
}

}  // namespace

CsvRows::CsvRows(std::string_view text) : rest_(text) {
  if (rest_.starts_with("\xef\xbb\xbf")) rest_.remove_prefix(3);  // a byte order mark
  std::string_view line;
  if (take_content(line)) split(line, names_);
}

bool CsvRows::take_content(std::string_view& line) {
  while (!rest_.empty()) {
    line = take_line(rest_);
    const std::size_t begin = line.find_first_not_of(" \t");
    if (begin != std::string_view::npos && line[begin] != '#') return true;
    ++ignored_;
  }
  return false;
}

std::optional<std::size_t> CsvRows::column(std::string_view name) const {
  const auto found = std::find(names_.begin(), names_.end(), name);
  if (found == names_.end()) return std::nullopt;
  return static_cast<std::size_t>(found - names_.begin());
}

bool CsvRows::next() {
  std::string_view line;
  if (!take_content(line)) return false;
  split(line, fields_);
  return true;
}

std::optional<std::string_view> CsvRows::text(std::size_t column) const {
  return column < fields_.size() ? std::optional(fields_[column]) : std::nullopt;
}

std::optional<double> CsvRows::real(std::size_t column) const {
  const auto field = text(column);
  return field ? whole_real(*field) : std::nullopt;
}

std::optional<double> CsvRows::finite(std::size_t column) const {
  const auto value = real(column);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

std::optional<Duration> CsvRows::seconds(std::size_t column) const {
  const auto field = text(column);
  return field ? any_seconds(*field) : std::nullopt;
}

bool csv_has(std::string_view text, std::string_view name) { return CsvRows(text).has(name); }

}  // namespace fude
