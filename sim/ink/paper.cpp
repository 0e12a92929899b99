#include "sim/ink/paper.h"

#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <sstream>

namespace fude {
namespace {

constexpr std::array table{
#define PARAMETER(id, unit, low, high, standard, meaning) \
  PaperParameter{#id, unit, low, high, standard, meaning, &PaperSpec::id},
#include "sim/ink/paper_parameters.inl"
#undef PARAMETER
};

std::string number(double x) {
  std::ostringstream text;
  text << x;
  return text.str();
}

Result<void> set(PaperSpec& paper, std::string_view key, const toml::node& node, const std::string& source) {
  const auto row = std::ranges::find(table, key, &PaperParameter::id);
  if (row == table.end())
    return failure(Fault::malformed, source + ": no ink parameter is called '" + std::string(key) + "'");
  const auto value = node.value<double>();
  if (!value || !std::isfinite(*value) || *value < row->low || *value > row->high)
    return failure(Fault::malformed, source + ": " + std::string(key) + " must be a number from " +
                                         number(row->low) + " to " + number(row->high) + " " +
                                         std::string(row->unit));
  paper.*(row->value) = *value;
  return {};
}

}  // namespace

std::span<const PaperParameter> paper_parameters() { return table; }

Result<PaperSpec> read_paper(std::string_view text, const std::string& source) {
  toml::table root;
  try {
    root = toml::parse(text);
  } catch (const toml::parse_error& error) {
    return failure(Fault::malformed, source + ", line " + std::to_string(error.source().begin.line) + ": " +
                                         std::string(error.description()));
  }
  PaperSpec paper;
  paper.name = root["name"].value_or(paper.name);
  if (const toml::table* ink = root["ink"].as_table())
    for (const auto& [key, node] : *ink)
      if (auto done = set(paper, key.str(), node, source); !done) return tl::unexpected(done.error());
  return paper;
}

Result<PaperSpec> load_paper(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) return failure(Fault::not_found, "cannot open the paper " + file.string());
  std::ostringstream text;
  text << in.rdbuf();
  return read_paper(text.str(), file.string());
}

}  // namespace fude
