#include "drivers/handle/handle_decoder.h"

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <numbers>
#include <utility>

namespace fude {
namespace {

constexpr double gravity_mps2 = 9.80665;
constexpr double full_scale_counts = 32768;
constexpr Duration patience = std::chrono::milliseconds(200);

Eigen::Vector3d scaled(const std::array<std::int16_t, 3>& counts, double full_scale) {
  return Eigen::Vector3d(counts[0], counts[1], counts[2]) * (full_scale / full_scale_counts);
}

bool at_end(const std::array<std::int16_t, 3>& counts) {
  return std::any_of(counts.begin(), counts.end(),
                     [](std::int16_t c) { return c == INT16_MIN || c == INT16_MAX; });
}

Transfer ask_for_scale(Timestamp time) {
  Transfer transfer;
  transfer.time = time;
  transfer.direction = Direction::to_device;
  transfer.kind = TransferKind::hid_ask;
  transfer.payload = octets({handle::scale_number});
  return transfer;
}

}  // namespace

std::vector<Transfer> HandleDecoder::greeting() { return {ask_for_scale({})}; }

void HandleDecoder::decode(const Transfer& transfer, Decoded& out) {
  if (transfer.direction != Direction::from_device) return;
  switch (transfer.kind) {
    case TransferKind::unplugged:
    case TransferKind::suspended:
      stream_.interrupted();
      scale_.reset();
      asked_.reset();
      return;
    case TransferKind::hid_feature:
      if (auto scale = handle::read_scale(transfer.payload)) {
        ++counts_.reports;
        scale_ = std::move(scale);
      } else {
        ++counts_.malformed;
      }
      return;
    case TransferKind::hid_report:
      if (const auto motion = handle::read_motion(transfer.payload))
        take_motion(*motion, transfer, out);
      else
        ++counts_.malformed;
      return;
    default:
      return;
  }
}

void HandleDecoder::take_motion(const handle::Motion& motion, const Transfer& transfer, Decoded& out) {
  const auto place = stream_.place(motion.sequence, motion.tick_us, transfer.time);
  if (place.repeated) {
    ++counts_.malformed;
    return;
  }
  ++counts_.reports;
  counts_.lost += place.lost;
  after_gap_ = after_gap_ || place.after_gap;
  if (!scale_) {
    if (!asked_) asked_ = transfer.time;
    if (transfer.time - *asked_ >= patience) {
      asked_ = transfer.time;
      out.replies.push_back(ask_for_scale(transfer.time));
    }
    after_gap_ = true;
    return;
  }
  ImuSample sample;
  sample.time = {transfer.time, transfer.stamped_by, place.sequence, place.tick_us};
  sample.turn_rate_radps = scaled(motion.turn_rate, scale_->turn_rate_degps * (std::numbers::pi / 180));
  sample.specific_force_mps2 =
      scaled(motion.specific_force, scale_->specific_force_mg * (gravity_mps2 / 1000));
  if (scale_->has_magnetometer && motion.magnetic_field_is_new)
    sample.magnetic_field_ut = scaled(motion.magnetic_field, scale_->magnetic_field_ut);
  sample.temperature_c = motion.temperature_c;
  if (motion.battery) sample.battery = Fraction(*motion.battery);
  sample.buttons = motion.buttons;
  sample.saturated = at_end(motion.turn_rate) || at_end(motion.specific_force);
  sample.valid = motion.measured;
  sample.after_gap = std::exchange(after_gap_, false);
  ++counts_.samples;
  out.samples.emplace_back(sample);
}

}  // namespace fude
