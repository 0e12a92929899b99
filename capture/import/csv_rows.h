// A table of text: a row of names, then rows of fields between commas. Fields hold no commas of their own;
// quotes around a field are taken off. Empty lines and lines that begin with # are passed over.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "signal/timestamp.h"

namespace fude {

class CsvRows {
 public:
  explicit CsvRows(std::string_view text);

  const std::vector<std::string_view>& names() const { return names_; }
  std::optional<std::size_t> column(std::string_view name) const;
  bool has(std::string_view name) const { return column(name).has_value(); }

  // Goes on to the next row; false at the end.
  bool next();
  bool whole() const { return fields_.size() == names_.size(); }  // as many fields as names
  std::size_t ignored() const { return ignored_; }                // lines without content so far

  // Of this row; none beyond its end.
  std::optional<std::string_view> text(std::size_t column) const;
  std::optional<double> real(std::size_t column) const;       // none: no number; "nan" is one
  std::optional<double> finite(std::size_t column) const;     // nor is that here
  std::optional<Duration> seconds(std::size_t column) const;  // 0 to 136 years

 private:
  bool take_content(std::string_view& line);

  std::string_view rest_;
  std::vector<std::string_view> names_;
  std::vector<std::string_view> fields_;
  std::size_t ignored_ = 0;
};

// The names in the first row of content, without reading further.
bool csv_has(std::string_view text, std::string_view name);

}  // namespace fude
