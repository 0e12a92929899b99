#include "rig/calibration/calibration_file.h"

#include <toml++/toml.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>

namespace fude {
namespace {

std::string toml_string(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      char code[8];
      std::snprintf(code, sizeof code, "\\u%04X", static_cast<unsigned>(c));
      out += code;
    } else {
      out += c;
    }
  }
  return out + "\"";
}

// A TOML float needs a point or an exponent; infinite and absent numbers have words.
std::string number(double value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value < 0 ? "-inf" : "inf";
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", value);
  std::string out = text;
  return out.find_first_of(".e") == std::string::npos ? out + ".0" : out;
}

template <class T, class Word>
std::string list(const std::vector<T>& values, Word word) {
  std::string out = "[";
  for (std::size_t i = 0; i < values.size(); ++i) out.append(i > 0 ? ", " : "").append(word(values[i]));
  return out + "]";
}

std::string line(const Field& field) {
  struct Writer {
    std::string operator()(double v) const { return number(v); }
    std::string operator()(const std::string& v) const { return toml_string(v); }
    std::string operator()(const std::vector<double>& v) const { return list(v, number); }
    std::string operator()(const std::vector<std::string>& v) const { return list(v, toml_string); }
  };
  return field.key + " = " + std::visit(Writer{}, field.value) + "\n";
}

std::optional<FieldValue> value_of(const toml::node& node) {
  if (const auto text = node.value_exact<std::string>()) return *text;
  if (node.is_number()) return node.value<double>().value();
  const toml::array* items = node.as_array();
  if (items == nullptr) return std::nullopt;
  std::vector<double> numbers;
  std::vector<std::string> words;
  for (const toml::node& item : *items) {
    if (const auto text = item.value_exact<std::string>())
      words.push_back(*text);
    else if (item.is_number())
      numbers.push_back(item.value<double>().value());
    else
      return std::nullopt;
  }
  if (!words.empty() && !numbers.empty()) return std::nullopt;
  if (!words.empty()) return words;
  return numbers;
}

std::vector<std::string> words_in(const toml::table& table, std::string_view key) {
  std::vector<std::string> words;
  if (const toml::array* items = table[key].as_array())
    for (const toml::node& item : *items)
      if (const auto text = item.value<std::string>()) words.push_back(*text);
  return words;
}

std::optional<double> optional_number(const toml::table& table, std::string_view key) {
  return table[key].value<double>();
}

CalibrationReport report_from(const toml::table& table) {
  CalibrationReport report;
  report.to_frame = table["to_frame"].value_or("");
  report.from_frame = table["from_frame"].value_or("");
  report.unit = table["unit"].value_or("");
  report.rms = table["rms"].value_or(0.0);
  report.rms_per_coordinate = table["rms_per_coordinate"].value_or(0.0);
  report.p95 = table["p95"].value_or(0.0);
  report.max = table["max"].value_or(0.0);
  report.n = static_cast<std::size_t>(std::max(0.0, table["n"].value_or(0.0)));
  report.held_out_rms = optional_number(table, "held_out_rms");
  report.condition = optional_number(table, "condition");
  if (const toml::array* interval = table["ci95"].as_array(); interval != nullptr && interval->size() == 2)
    report.ci95 = {(*interval)[0].value_or(0.0), (*interval)[1].value_or(0.0)};
  report.accepted = table["accepted"].value_or(false);
  report.reason = table["reason"].value_or("");
  report.warnings = words_in(table, "warnings");
  report.date = table["date"].value_or("");
  report.devices = words_in(table, "devices");
  report.tool = table["tool"].value_or("");
  report.reference = table["reference"].value_or("");
  report.session = table["session"].value_or("");
  return report;
}

}  // namespace

std::string toml_of(const StoredCalibration& calibration) {
  const CalibrationReport& r = calibration.report;
  std::string text = "procedure = " + toml_string(r.procedure) + "\n";
  for (const Field& field : calibration.result) text += line(field);
  text += "\n[report]\naccepted = ";
  text += r.accepted ? "true\n" : "false\n";
  std::vector<Field> fields{{"reason", r.reason},
                            {"to_frame", r.to_frame},
                            {"from_frame", r.from_frame},
                            {"unit", r.unit},
                            {"rms", r.rms},
                            {"rms_per_coordinate", r.rms_per_coordinate},
                            {"p95", r.p95},
                            {"max", r.max}};
  if (r.held_out_rms) fields.push_back({"held_out_rms", *r.held_out_rms});
  if (r.ci95) fields.push_back({"ci95", std::vector{(*r.ci95)[0], (*r.ci95)[1]}});
  if (r.condition) fields.push_back({"condition", *r.condition});
  fields.push_back({"warnings", r.warnings});
  fields.push_back({"date", r.date});
  fields.push_back({"devices", r.devices});
  fields.push_back({"tool", r.tool});
  fields.push_back({"reference", r.reference});
  fields.push_back({"session", r.session});
  for (const Field& field : fields) text += line(field);
  text += "n = " + std::to_string(r.n) + "\n";
  text += "\n[report.details]\n";
  for (const Field& field : r.details) text += line(field);
  return text;
}

Result<StoredCalibration> calibration_from_toml(std::string_view text, const std::string& source) {
  toml::table table;
  try {
    table = toml::parse(text, source);
  } catch (const toml::parse_error& e) {
    return failure(Fault::malformed, source + ": line " + std::to_string(e.source().begin.line) + ": " +
                                         std::string(e.description()));
  }
  StoredCalibration calibration;
  if (const toml::table* report = table["report"].as_table()) {
    calibration.report = report_from(*report);
    if (const toml::table* details = (*report)["details"].as_table())
      for (const auto& [key, node] : *details)
        if (auto value = value_of(node)) calibration.report.detail(std::string(key.str()), std::move(*value));
  }
  calibration.report.procedure = table["procedure"].value_or("");
  if (calibration.report.procedure.empty())
    return failure(Fault::malformed, source + " is no calibration: it names no procedure");
  if (!calibration.report.accepted)
    return failure(Fault::malformed, source + " was never accepted; calibrate again");
  for (const auto& [key, node] : table) {
    if (key == "procedure" || key == "report") continue;
    auto value = value_of(node);
    if (!value)
      return failure(Fault::malformed, source + ": line " + std::to_string(node.source().begin.line) + ": " +
                                           std::string(key.str()) +
                                           " is neither a number, a word nor a list");
    calibration.result.push_back({std::string(key.str()), std::move(*value)});
  }
  return calibration;
}

Result<StoredCalibration> read_calibration(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) return failure(Fault::not_found, file.string() + " cannot be read");
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  return calibration_from_toml(text, file.string());
}

}  // namespace fude
