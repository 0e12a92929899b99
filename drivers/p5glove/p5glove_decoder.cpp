#include "drivers/p5glove/p5glove_decoder.h"

#include <cstdlib>
#include <utility>

namespace fude {
namespace {

using namespace p5glove;

constexpr std::int32_t widest_tangent = 615;  // of 512ths: beyond what ten bits hold

Transfer to_glove(TransferKind kind, std::vector<std::byte> payload) {
  Transfer transfer;
  transfer.direction = Direction::to_device;
  transfer.kind = kind;
  transfer.payload = std::move(payload);
  return transfer;
}

// The value, or one turn of ten bits away, whichever is nearer to the one before.
std::int32_t unwrapped(std::int32_t value, std::int32_t before) {
  const std::int32_t other = value < 0 ? value + 1024 : value - 1024;
  return std::abs(other) <= widest_tangent && std::abs(other - before) < std::abs(value - before) ? other
                                                                                                  : value;
}

Sighting unwrapped(Sighting sighting, const std::optional<Sighting>& before) {
  if (!before) return sighting;
  for (std::size_t i = 0; i < 2; ++i)
    sighting.vertical[i] = unwrapped(sighting.vertical[i], before->vertical[i]);
  sighting.horizontal = unwrapped(sighting.horizontal, before->horizontal);
  return sighting;
}

}  // namespace

std::vector<Transfer> P5GloveDecoder::greeting() {
  return {to_glove(TransferKind::hid_feature, octets({5, 0xff})),
          to_glove(TransferKind::hid_ask, octets({heads_number})),
          to_glove(TransferKind::hid_ask, octets({lights_number}))};
}

void P5GloveDecoder::decode(const Transfer& transfer, Decoded& out) {
  if (transfer.direction != Direction::from_device) return;
  switch (transfer.kind) {
    case TransferKind::unplugged:
    case TransferKind::suspended:
      seen_ = {};
      heads_.clear();
      lights_.clear();
      tower_.reset();
      after_gap_ = true;
      return;
    case TransferKind::hid_feature:
      return take_feature(transfer);
    case TransferKind::hid_report:
      if (const auto report = read_report(transfer.payload))
        take_report(*report, transfer, out);
      else
        ++counts_.malformed;
      return;
    default:
      return;
  }
}

void P5GloveDecoder::take_feature(const Transfer& transfer) {
  if (transfer.payload.empty()) {
    ++counts_.malformed;
    return;
  }
  switch (octet(transfer.payload, 0)) {
    case heads_number:
      heads_ = transfer.payload;
      break;
    case lights_number:
      lights_ = transfer.payload;
      break;
    default:
      ++counts_.unknown;
      return;
  }
  ++counts_.reports;
  tower_ = read_tower(heads_, lights_);
}

void P5GloveDecoder::take_report(const Report& report, const Transfer& transfer, Decoded& out) {
  ++counts_.reports;
  GloveSample sample;
  sample.time = {transfer.time, transfer.stamped_by, sequence_++, std::nullopt};
  for (std::size_t finger = 0; finger < glove_fingers; ++finger)
    sample.bend[finger] = Fraction(report.bend[(finger + 4) % glove_fingers] / 63.0);  // thumb first
  sample.buttons = report.buttons;
  std::array<std::optional<Sighting>, glove_lights> seen{};
  for (const auto& sighting : report.sightings) {
    if (!sighting || seen[sighting->light]) continue;
    const Sighting whole = unwrapped(*sighting, seen_[sighting->light]);
    seen[sighting->light] = whole;
    if (tower_) sample.lights[sighting->light] = place_of(whole, *tower_);
  }
  seen_ = seen;
  sample.after_gap = std::exchange(after_gap_, false);
  ++counts_.samples;
  out.samples.emplace_back(sample);
}

}  // namespace fude
