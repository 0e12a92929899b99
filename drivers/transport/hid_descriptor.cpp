#include "drivers/transport/hid_descriptor.h"

#include <array>

namespace fude::hid {
namespace {

constexpr std::size_t most_fields = 4096;
constexpr std::size_t most_nested = 64;
constexpr std::uint32_t most_report_bits = 8 * 8192;

constexpr std::array<std::size_t, 4> item_bytes{0, 1, 2, 4};

// Tag and type of an item: its first byte without the length.
enum Item : std::uint8_t {
  input = 0x80,
  output = 0x90,
  collection = 0xa0,
  feature = 0xb0,
  end_collection = 0xc0,
  usage_page = 0x04,
  logical_minimum = 0x14,
  logical_maximum = 0x24,
  physical_minimum = 0x34,
  physical_maximum = 0x44,
  unit_exponent = 0x54,
  unit = 0x64,
  report_size = 0x74,
  report_id = 0x84,
  report_count = 0x94,
  push = 0xa4,
  pop = 0xb4,
  local_usage = 0x08,
  local_usage_minimum = 0x18,
  local_usage_maximum = 0x28,
};

struct Globals {
  std::uint16_t page = 0;
  Field field;  // report, ranges, unit and bits of the fields to come
  std::uint32_t count = 0;
  std::uint32_t logical_maximum_unsigned = 0;
};

struct Locals {
  std::vector<Usage> usages;
  std::optional<Usage> minimum;
  std::optional<Usage> maximum;

  // The last usage goes for all fields beyond it.
  Usage of(std::uint32_t index) const {
    if (!usages.empty()) return usages[std::min<std::size_t>(index, usages.size() - 1)];
    if (!minimum) return 0;
    const Usage last = maximum && *maximum >= *minimum ? *maximum : *minimum;
    return *minimum + std::min(index, last - *minimum);
  }
};

class Parser {
 public:
  Result<Descriptor> parse(Bytes bytes) {
    while (!bytes.empty()) {
      const std::uint8_t prefix = octet(bytes, 0);
      const bool long_item = prefix == 0xfe;
      if (long_item && bytes.size() < 2) return cut();
      const std::size_t length = long_item ? octet(bytes, 1) + std::size_t{2} : item_bytes[prefix & 3];
      if (bytes.size() < length + 1) return cut();
      if (!long_item && !take(prefix & 0xfc, bytes.subspan(1, length))) return tl::unexpected(wrong_);
      bytes = bytes.subspan(length + 1);
    }
    return std::move(descriptor_);
  }

 private:
  static Result<Descriptor> cut() { return failure(Fault::malformed, "the report descriptor is cut off"); }

  bool refuse(std::string why) {
    wrong_ = {Fault::malformed, std::move(why)};
    return false;
  }

  bool take(int item, Bytes data) {
    std::uint32_t number = 0;
    for (std::size_t i = data.size(); i-- > 0;) number = number << 8 | octet(data, i);
    const unsigned unused_bits = 32 - 8 * static_cast<unsigned>(data.size());
    const auto signed_number =
        data.empty() ? 0 : static_cast<std::int32_t>(number << unused_bits) >> unused_bits;
    // A usage of four bytes brings its page with it.
    const Usage full = data.size() == 4 ? number : usage(globals_.page, static_cast<std::uint16_t>(number));
    switch (item) {
      case usage_page:
        globals_.page = static_cast<std::uint16_t>(number);
        break;
      case logical_minimum:
        globals_.field.logical_minimum = signed_number;
        break;
      case logical_maximum:
        globals_.field.logical_maximum = signed_number;
        globals_.logical_maximum_unsigned = number;
        break;
      case physical_minimum:
        globals_.field.physical_minimum = signed_number;
        break;
      case physical_maximum:
        globals_.field.physical_maximum = signed_number;
        break;
      case unit_exponent:  // a nibble, signed, however long the item is
        globals_.field.unit_exponent = static_cast<int>((number & 15) ^ 8) - 8;
        break;
      case unit:
        globals_.field.unit = number;
        break;
      case report_size:
        globals_.field.bits = number;
        break;
      case report_count:
        globals_.count = number;
        break;
      case report_id:
        globals_.field.report = static_cast<std::uint8_t>(number);
        descriptor_.numbered = true;
        break;
      case push:
        if (stack_.size() >= most_nested) return refuse("the report descriptor saves its state too often");
        stack_.push_back(globals_);
        break;
      case pop:
        if (stack_.empty()) return refuse("the report descriptor restores a state that it did not save");
        globals_ = stack_.back();
        stack_.pop_back();
        break;
      case local_usage:
        if (locals_.usages.size() < most_fields) locals_.usages.push_back(full);
        break;
      case local_usage_minimum:
        locals_.minimum = full;
        break;
      case local_usage_maximum:
        locals_.maximum = full;
        break;
      case collection:
        if (applications_.size() >= most_nested) return refuse("the report descriptor nests too deeply");
        applications_.push_back(applications_.empty() ? locals_.of(0) : applications_.front());
        locals_ = {};
        break;
      case end_collection:
        if (!applications_.empty()) applications_.pop_back();
        locals_ = {};
        break;
      case input:
        if (!add_inputs(number)) return false;
        locals_ = {};
        break;
      case output:
      case feature:
        locals_ = {};
        break;
      default:
        break;
    }
    return true;
  }

  bool add_inputs(std::uint32_t flags) {
    std::uint32_t& at = next_bit_[globals_.field.report];
    const std::uint64_t end = at + std::uint64_t{globals_.field.bits} * globals_.count;
    if (end > most_report_bits) return refuse("a report of the descriptor is longer than 8 KiB");
    const bool constant = flags & 1, variable = flags & 2;
    if (!constant && variable && globals_.field.bits >= 1 && globals_.field.bits <= 32) {
      Field field = globals_.field;
      // Descriptors often write an unsigned maximum in too few bytes.
      if (field.logical_minimum >= 0 && field.logical_maximum < field.logical_minimum)
        field.logical_maximum = static_cast<std::int32_t>(globals_.logical_maximum_unsigned);
      field.relative = flags & 4;
      field.application = applications_.empty() ? 0 : applications_.front();
      for (std::uint32_t i = 0; i < globals_.count; ++i) {
        if (descriptor_.inputs.size() >= most_fields) return refuse("the descriptor has too many fields");
        field.first_bit = at + i * field.bits;
        field.usage = locals_.of(i);
        descriptor_.inputs.push_back(field);
      }
    }
    at = static_cast<std::uint32_t>(end);
    return true;
  }

  Descriptor descriptor_;
  Globals globals_;
  Locals locals_;
  std::vector<Globals> stack_;
  std::vector<Usage> applications_;  // the outermost one's, once for each level
  std::array<std::uint32_t, 256> next_bit_{};
  Error wrong_{};
};

// The field's first bit, that of the report's number being the first of all.
std::size_t in_report(const Field& field) { return field.first_bit + (field.report != 0 ? 8U : 0U); }

}  // namespace

Result<Descriptor> parse_descriptor(Bytes descriptor) { return Parser().parse(descriptor); }

std::size_t bytes_through(const Field& field) { return (in_report(field) + field.bits + 7) / 8; }

std::optional<std::int32_t> value(const Field& field, Bytes report) {
  if (field.bits == 0 || field.bits > 32 || report.size() < bytes_through(field)) return std::nullopt;
  if (field.report != 0 && octet(report, 0) != field.report) return std::nullopt;
  const std::size_t first = in_report(field);
  std::uint64_t bits = 0;
  const std::size_t last = (first + field.bits - 1) / 8;
  for (std::size_t i = last + 1; i-- > first / 8;) bits = bits << 8 | octet(report, i);
  bits = bits >> (first % 8) & ((std::uint64_t{1} << field.bits) - 1);
  if (field.logical_minimum < 0 && bits >> (field.bits - 1) & 1) bits |= ~std::uint64_t{0} << field.bits;
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(bits));
}

std::optional<double> span_mm(const Field& field) {
  const bool inches = field.unit == 0x13;
  if (!inches && field.unit != 0x11) return std::nullopt;
  double span = static_cast<double>(field.physical_maximum) - static_cast<double>(field.physical_minimum);
  if (!(span > 0)) return std::nullopt;
  for (int i = 0; i < field.unit_exponent; ++i) span *= 10;
  for (int i = 0; i > field.unit_exponent; --i) span /= 10;
  return span * (inches ? 25.4 : 10.0);
}

}  // namespace fude::hid
