#include "drivers/polhemus/record.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "signal/elementary.h"

namespace fude::polhemus {
namespace {

enum class Meaning : std::uint8_t {
  blank,
  line_end,
  position,
  euler,
  quaternion,
  time_ms,
  frame,
  stylus,
  distortion,
  other
};

struct Item {
  Dialect dialect;
  unsigned number;
  std::size_t bytes;
  Meaning meaning;
};
constexpr Item items[] = {
#define POLHEMUS_ITEM(dialect, number, bytes, meaning) {Dialect::dialect, number, bytes, Meaning::meaning},
#include "drivers/polhemus/items.inl"
#undef POLHEMUS_ITEM
};

constexpr double farthest_m = 100;
constexpr std::size_t fastrak_head = 3;
constexpr std::size_t liberty_head = 8;

const Item* item_of(Dialect dialect, unsigned number) {
  const Item* item = std::find_if(std::begin(items), std::end(items),
                                  [&](const Item& i) { return i.dialect == dialect && i.number == number; });
  return item == std::end(items) ? nullptr : item;
}

double real(Bytes bytes, std::size_t at) {
  return std::bit_cast<float>(little_endian<std::uint32_t>(bytes, at));
}

Eigen::Vector3d three(Bytes bytes, std::size_t at) {
  return {real(bytes, at), real(bytes, at + 4), real(bytes, at + 8)};
}

// Azimuth about z, then elevation about y, then roll about x, in degrees.
Eigen::Quaterniond from_euler(const Eigen::Vector3d& degrees) {
  const auto about = [](double degree, const Eigen::Vector3d& axis) {
    const auto half = elementary::sine_cosine(degree * (std::numbers::pi / 360));
    return Eigen::Quaterniond(half.cosine, axis.x() * half.sine, axis.y() * half.sine, axis.z() * half.sine);
  };
  return about(degrees[0], Eigen::Vector3d::UnitZ()) * about(degrees[1], Eigen::Vector3d::UnitY()) *
         about(degrees[2], Eigen::Vector3d::UnitX());
}

bool is_flag(std::uint8_t error) { return error != ' ' && error != 0; }

// Reads the body into `record`; false where a number cannot be or a blank is none.
bool read_body(Bytes body, const Layout& layout, Record& record) {
  const double metres = layout.centimetres ? 0.01 : 0.0254;
  std::size_t at = 0;
  for (unsigned number : layout.items) {
    const Item& item = *item_of(layout.dialect, number);
    switch (item.meaning) {
      case Meaning::blank:
        if (octet(body, at) != ' ') return false;
        break;
      case Meaning::line_end:
        if (octet(body, at) != '\r' || octet(body, at + 1) != '\n') return false;
        break;
      case Meaning::position: {
        const Eigen::Vector3d position = three(body, at) * metres;
        const bool possible = position.allFinite() && position.cwiseAbs().maxCoeff() < farthest_m;
        if (!possible && !record.flagged) return false;
        if (possible) record.position_m = position;
        break;
      }
      case Meaning::euler: {
        const Eigen::Vector3d degrees = three(body, at);
        const bool possible = degrees.allFinite() && degrees.cwiseAbs().maxCoeff() <= 361;
        if (!possible && !record.flagged) return false;
        if (possible) record.rotation = from_euler(degrees).normalized();
        break;
      }
      case Meaning::quaternion: {
        const Eigen::Quaterniond turn(real(body, at), real(body, at + 4), real(body, at + 8),
                                      real(body, at + 12));
        const bool possible = turn.coeffs().allFinite() && std::abs(turn.norm() - 1) < 0.05;
        if (!possible && !record.flagged) return false;
        if (possible) record.rotation = turn.normalized();
        break;
      }
      case Meaning::time_ms:
        record.time_ms = little_endian<std::uint32_t>(body, at);
        break;
      case Meaning::frame:
        record.frame = little_endian<std::uint32_t>(body, at);
        break;
      case Meaning::stylus:
        record.stylus = little_endian<std::uint32_t>(body, at);
        break;
      case Meaning::distortion:
        record.distortion = little_endian<std::int32_t>(body, at);
        break;
      case Meaning::other:
        break;
    }
    at += item.bytes;
  }
  return true;
}

std::optional<Record> read_fastrak(Bytes frame, const Layout& layout) {
  Record record;
  record.station = octet(frame, 1) - unsigned{'0'};
  record.flagged = is_flag(octet(frame, 2));
  if (!read_body(frame.subspan(fastrak_head), layout, record)) return std::nullopt;
  return record;
}

std::optional<Record> read_liberty(Bytes frame, const Layout& layout) {
  Record record;
  record.station = octet(frame, 2);
  record.flagged = is_flag(octet(frame, 4));
  if (!read_body(frame.subspan(liberty_head), layout, record)) return std::nullopt;
  return record;
}

FrameFit fit_fastrak(Bytes bytes, const Layout& layout, std::size_t body) {
  if (octet(bytes, 0) != '0') return {FrameFit::Kind::none};
  if (bytes.size() < fastrak_head + body) return {FrameFit::Kind::needs_more};
  const bool head =
      octet(bytes, 1) >= '1' && octet(bytes, 1) <= '4' && octet(bytes, 2) >= 0x20 && octet(bytes, 2) < 0x7f;
  if (!head) return {FrameFit::Kind::none};
  if (!read_fastrak(bytes.first(fastrak_head + body), layout)) return {FrameFit::Kind::damaged};
  return {FrameFit::Kind::whole, fastrak_head + body};
}

bool is_measurement(Bytes head, std::size_t body) {
  const std::uint8_t command = octet(head, 3);
  return (command == 'C' || command == 'P') && little_endian<std::uint16_t>(head, 6) == body;
}

FrameFit fit_liberty(Bytes bytes, const Layout& layout, std::size_t body) {
  const auto begins = [&](char a, char b) {
    return octet(bytes, 0) == a && (bytes.size() < 2 || octet(bytes, 1) == b);
  };
  if (!begins('L', 'Y') && !begins('P', 'A') && !begins('L', 'U')) return {FrameFit::Kind::none};
  if (bytes.size() < liberty_head) return {FrameFit::Kind::needs_more};
  const std::size_t length = liberty_head + little_endian<std::uint16_t>(bytes, 6);
  const std::uint8_t error = octet(bytes, 4);
  if (length > longest_record || (error != 0 && (error < 0x20 || error > 0x7e)))
    return {FrameFit::Kind::damaged};
  if (bytes.size() < length) return {FrameFit::Kind::needs_more};
  if (is_measurement(bytes, body)) {
    const unsigned station = octet(bytes, 2);
    if (station < 1 || station > 16 || !read_liberty(bytes.first(length), layout))
      return {FrameFit::Kind::damaged};
  }
  return {FrameFit::Kind::whole, length};
}

}  // namespace

Layout usual_layout(Dialect dialect) {
  if (dialect == Dialect::fastrak) return {dialect, {2, 11, 1}, true};
  return {dialect, {8, 9, 10, 11, 2, 7}, true};
}

std::optional<std::size_t> body_length(const Layout& layout) {
  std::size_t length = 0;
  for (unsigned number : layout.items) {
    const Item* item = item_of(layout.dialect, number);
    if (item == nullptr) return std::nullopt;
    length += item->bytes;
  }
  return length;
}

FrameFit fit_record(Bytes bytes, const Layout& layout) {
  const auto body = body_length(layout);
  if (!body || bytes.empty()) return {FrameFit::Kind::none};
  return layout.dialect == Dialect::fastrak ? fit_fastrak(bytes, layout, *body)
                                            : fit_liberty(bytes, layout, *body);
}

std::optional<Record> read_record(Bytes frame, const Layout& layout) {
  const FrameFit fit = fit_record(frame, layout);
  if (fit.kind != FrameFit::Kind::whole || fit.length != frame.size()) return std::nullopt;
  if (layout.dialect == Dialect::fastrak) return read_fastrak(frame, layout);
  if (!is_measurement(frame, *body_length(layout))) return std::nullopt;
  return read_liberty(frame, layout);
}

}  // namespace fude::polhemus
