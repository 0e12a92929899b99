#include "capture/import/evdev_description.h"

#include <linux/input-event-codes.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "capture/import/text_fields.h"

namespace fude {
namespace {

constexpr std::size_t longest_name = 256;

void trim(std::string_view& text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
}

bool take_prefix(std::string_view& text, std::string_view prefix) {
  if (!text.starts_with(prefix)) return false;
  text.remove_prefix(prefix.size());
  return true;
}

// "0x56a" of "bus 0x03 vendor 0x56a product 0x304 version 0x90".
std::optional<std::uint16_t> hex_after(std::string_view text, std::string_view word) {
  const std::size_t at = text.find(word);
  if (at == std::string_view::npos) return std::nullopt;
  text.remove_prefix(at + word.size());
  std::string_view field = take_field(text);
  take_prefix(field, "0x");
  return whole_integer<std::uint16_t>(field, 16);
}

// "3" of "3 (EV_ABS)".
int leading_number(std::string_view text) {
  const auto number = whole_integer<std::uint16_t>(take_field(text));
  return number ? *number : -1;
}

template <class T>
void sort_unique(std::vector<T>& codes) {
  std::sort(codes.begin(), codes.end());
  codes.erase(std::unique(codes.begin(), codes.end()), codes.end());
}

}  // namespace

AxisRange& DescriptionReader::axis(std::uint16_t code) {
  for (AxisRange& a : device_.axes)
    if (a.code == code) return a;
  device_.axes.push_back({.code = code});
  return device_.axes.back();
}

void DescriptionReader::comment(std::string_view line) {
  take_prefix(line, "#");
  trim(line);
  if (take_prefix(line, "Input device name:")) {
    found_ = true;
    trim(line);
    if (line.size() >= 2 && line.front() == '"') line = line.substr(1, line.size() - 2);
    device_.name = line.substr(0, longest_name);
  } else if (take_prefix(line, "Input device ID:")) {
    device_.bus = hex_after(line, "bus ").value_or(0);
    device_.vendor = hex_after(line, "vendor ").value_or(0);
    device_.product = hex_after(line, "product ").value_or(0);
    device_.version = hex_after(line, "version ").value_or(0);
  } else if (take_prefix(line, "Event type ")) {
    comment_type_ = leading_number(line);
    comment_code_ = -1;
  } else if (take_prefix(line, "Event code ")) {
    comment_code_ = leading_number(line);
    if (comment_type_ == EV_KEY && comment_code_ >= 0 && comment_code_ <= KEY_MAX)
      device_.keys.push_back(static_cast<std::uint16_t>(comment_code_));
  } else if (comment_type_ == EV_ABS && comment_code_ >= 0 && comment_code_ <= ABS_MAX) {
    const std::string_view name = take_field(line);
    const auto value = whole_integer<std::int32_t>(take_field(line));
    if (!value) return;
    AxisRange& a = axis(static_cast<std::uint16_t>(comment_code_));
    if (name == "Value") a.value = *value;
    if (name == "Min") a.minimum = *value;
    if (name == "Max") a.maximum = *value;
    if (name == "Fuzz") a.fuzz = *value;
    if (name == "Flat") a.flat = *value;
    if (name == "Resolution") a.resolution = *value;
  }
}

Result<bool> DescriptionReader::letter_line(std::string_view line) {
  if (line.size() < 2 || line[1] != ':') return false;
  const char letter = line[0];
  line.remove_prefix(2);
  if (letter == 'N') {
    trim(line);
    device_.name = line.substr(0, longest_name);
  } else if (letter == 'I') {
    for (std::uint16_t* number : {&device_.bus, &device_.vendor, &device_.product, &device_.version}) {
      const auto value = whole_integer<std::uint16_t>(take_field(line), 16);
      if (!value)
        return failure(Fault::malformed,
                       "the identity is not four hexadecimal numbers (bus, vendor, product, version)");
      *number = *value;
    }
  } else if (letter == 'P') {
    for (std::string_view field = take_field(line); !field.empty(); field = take_field(line)) {
      const auto byte = whole_integer<std::uint8_t>(field, 16);
      if (!byte) return failure(Fault::malformed, "a property is not a hexadecimal byte");
      for (std::size_t bit = 0; bit < 8; ++bit)
        if ((*byte >> bit & 1) && property_bytes_ * 8 + bit <= INPUT_PROP_MAX)
          device_.properties.push_back(static_cast<std::uint16_t>(property_bytes_ * 8 + bit));
      ++property_bytes_;
    }
  } else if (letter == 'B') {
    if (auto taken = bits(line); !taken) return tl::unexpected(taken.error());
  } else if (letter == 'A') {
    if (auto taken = axis_line(line); !taken) return tl::unexpected(taken.error());
  } else if (letter != 'L' && letter != 'S') {
    return false;
  }
  found_ = true;
  return true;
}

// "B: 01 ff 01 00 …": event type, then bytes of its bit mask, going on from the line before.
Result<void> DescriptionReader::bits(std::string_view fields) {
  const auto type = whole_integer<std::uint8_t>(take_field(fields), 16);
  if (!type) return failure(Fault::malformed, "the event type is not a hexadecimal byte");
  if (mask_bytes_.size() <= *type) mask_bytes_.resize(std::size_t{*type} + 1);
  std::size_t& at = mask_bytes_[*type];
  for (std::string_view field = take_field(fields); !field.empty(); field = take_field(fields)) {
    const auto byte = whole_integer<std::uint8_t>(field, 16);
    if (!byte) return failure(Fault::malformed, "a bit mask is not in hexadecimal bytes");
    for (std::size_t bit = 0; bit < 8; ++bit)
      if (*type == EV_KEY && (*byte >> bit & 1) && at * 8 + bit <= KEY_MAX)
        device_.keys.push_back(static_cast<std::uint16_t>(at * 8 + bit));
    ++at;
  }
  return {};
}

// "A: 1a 0 127 0 0 57": code, minimum, maximum, fuzz, flat and, since 1.2, resolution.
Result<void> DescriptionReader::axis_line(std::string_view fields) {
  const auto code = whole_integer<std::uint16_t>(take_field(fields), 16);
  if (!code || *code > ABS_MAX) return failure(Fault::malformed, "the axis has no hexadecimal code up to 3f");
  AxisRange& a = axis(*code);
  for (std::int32_t* number : {&a.minimum, &a.maximum, &a.fuzz, &a.flat, &a.resolution}) {
    const std::string_view field = take_field(fields);
    if (field.empty() && number == &a.resolution) break;
    const auto value = whole_integer<std::int32_t>(field);
    if (!value)
      return failure(Fault::malformed,
                     "the axis is not described by whole numbers (minimum, maximum, fuzz, flat, resolution)");
    *number = *value;
  }
  return {};
}

Result<DeviceDescription> DescriptionReader::finish() && {
  for (const AxisRange& a : device_.axes)
    if (a.maximum < a.minimum)
      return failure(Fault::malformed, "axis " + std::to_string(a.code) + " of \"" + device_.name +
                                           "\" ends below its beginning; mend its A: line");
  std::sort(device_.axes.begin(), device_.axes.end(),
            [](const AxisRange& a, const AxisRange& b) { return a.code < b.code; });
  sort_unique(device_.keys);
  sort_unique(device_.properties);
  device_.transport = "evdev";
  device_.id = device_id(device_);
  return std::move(device_);
}

}  // namespace fude
