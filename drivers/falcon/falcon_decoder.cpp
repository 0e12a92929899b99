#include "drivers/falcon/falcon_decoder.h"

#include <algorithm>
#include <cmath>

#include "drivers/falcon/ftdi.h"
#include "drivers/falcon/kinematics.h"

namespace fude {
namespace {

using namespace falcon;

struct Model {
  std::uint16_t product;
  double force_n;
  double motor_counts_per_nm;
  double motor_limit_counts;
  double middle_m;
};
constexpr Model models[] = {
#define FALCON_MODEL(product, name, force_n, motor_counts_per_nm, motor_limit_counts, middle_m) \
  {product, force_n, motor_counts_per_nm, motor_limit_counts, middle_m},
#include "drivers/falcon/models.inl"
#undef FALCON_MODEL
};
constexpr const Model& model = models[0];

constexpr Duration call_patience = std::chrono::milliseconds(200);
constexpr Duration poll_patience = std::chrono::milliseconds(20);
constexpr Duration velocity_window = std::chrono::milliseconds(10);
constexpr Duration least_step = std::chrono::microseconds(500);

// The motors pull against the encoders' direction.
Eigen::Vector3d torques_of(const ToArm& message) {
  return Eigen::Vector3d(message.motors[0], message.motors[1], message.motors[2]) /
         -model.motor_counts_per_nm;
}

}  // namespace

namespace falcon {

Eigen::Vector3d workspace_middle() { return {0, 0, model.middle_m}; }

ToArm force_message(const Eigen::Vector3d& position_m, const Eigen::Vector3d& force_n, std::uint8_t light) {
  ToArm message{.light = light};
  if (!force_n.allFinite() || force_n.isZero(0)) return message;
  const auto torques = leg_torques(position_m, force_n);
  if (!torques) return message;
  Eigen::Vector3d counts = *torques * -model.motor_counts_per_nm;
  if (const double largest = counts.cwiseAbs().maxCoeff(); largest > model.motor_limit_counts)
    counts *= model.motor_limit_counts / largest;
  for (std::size_t i = 0; i < 3; ++i)
    message.motors[i] = static_cast<std::int16_t>(std::lround(counts[static_cast<Eigen::Index>(i)]));
  return message;
}

}  // namespace falcon

FalconDecoder::FalconDecoder(std::vector<std::byte> firmware, bool polls)
    : polls_(polls),
      has_firmware_(!firmware.empty()),
      load_(std::move(firmware)),
      position_m_(workspace_middle()) {}

std::vector<Transfer> FalconDecoder::greeting() {
  state_ = State::unknown;
  silent_since_.reset();
  auto all = normal_mode();
  all.push_back(bulk(write_to_arm({.light = red})));
  return all;
}

void FalconDecoder::decode(const Transfer& transfer, Decoded& out) {
  if (transfer.kind == TransferKind::unplugged || transfer.kind == TransferKind::suspended) {
    state_ = State::unknown;
    silent_since_.reset();
    stream_.forget();
    position_m_ = workspace_middle();
    torques_nm_.setZero();
    before_.clear();
    after_gap_ = true;
    return;
  }
  if (transfer.kind != TransferKind::usb_bulk) return;
  if (transfer.direction == Direction::to_device) {
    if (const auto message = read_to_arm(transfer.payload)) torques_nm_ = torques_of(*message);
    return;
  }
  const auto bytes = without_status(transfer.payload);
  if (state_ == State::loading) {
    for (Transfer& reply : load_.hear(bytes, transfer.time)) out.replies.push_back(std::move(reply));
    if (load_.state() == FirmwareLoad::State::failed) state_ = State::failed;
    if (load_.state() == FirmwareLoad::State::loaded) {
      state_ = State::running;
      silent_since_ = transfer.time;
      poll(red, out);
    }
    return;
  }
  const auto samples = out.samples.size();
  counts_.malformed += stream_
                           .feed(bytes, message_length, fit_message,
                                 [&](Bytes message) {
                                   if (const auto read = read_from_arm(message))
                                     take_message(*read, transfer, out);
                                 })
                           .damaged;
  if (out.samples.size() == samples) wait(transfer, out);
}

// Nothing was said: the chip's empty packets still tell the time.
void FalconDecoder::wait(const Transfer& transfer, Decoded& out) {
  if (!silent_since_) silent_since_ = transfer.time;
  const Duration silence = transfer.time - *silent_since_;
  if (state_ == State::running && silence > poll_patience) {
    silent_since_ = transfer.time;
    poll(red, out);
  }
  if (state_ != State::unknown || silence <= call_patience) return;
  if (!has_firmware_) {
    state_ = State::no_firmware;
    return;
  }
  state_ = State::loading;
  for (Transfer& reply : load_.begin(transfer.time)) out.replies.push_back(std::move(reply));
}

void FalconDecoder::poll(std::uint8_t light, Decoded& out) {
  if (!polls_) return;
  torques_nm_.setZero();
  out.replies.push_back(bulk(write_to_arm({.light = light})));
}

// Over the last ten milliseconds: a single count of an encoder is a fifth of a millimetre a millisecond.
Eigen::Vector3d FalconDecoder::velocity_at(Timestamp now, const Eigen::Vector3d& position) {
  while (!before_.empty() && (now - before_.front().first > velocity_window || before_.front().first > now))
    before_.pop_front();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  if (!before_.empty() && now - before_.front().first >= least_step)
    velocity = (position - before_.front().second) / seconds(now - before_.front().first);
  before_.emplace_back(now, position);
  if (before_.size() > 64) before_.pop_front();
  return velocity;
}

void FalconDecoder::take_message(const FromArm& message, const Transfer& transfer, Decoded& out) {
  state_ = State::running;
  silent_since_ = transfer.time;
  ++counts_.reports;
  constexpr std::uint8_t every_leg = 7;
  HapticSample sample;
  sample.time = {transfer.time, transfer.stamped_by, sequence_++, std::nullopt};
  for (std::size_t i = 0; i < 3; ++i) sample.encoder_counts[i] = message.encoders[i];
  const Eigen::Vector3d angles(leg_angle(message.encoders[0]), leg_angle(message.encoders[1]),
                               leg_angle(message.encoders[2]));
  auto position = grip_position(angles, position_m_);
  if (!position) position = grip_position(angles, workspace_middle());
  sample.homed = message.homed == every_leg && position.has_value();
  if (position) {
    position_m_ = *position;
    sample.position_m = *position - workspace_middle();
    sample.velocity_mps = velocity_at(transfer.time, *position);
    if (const auto force = grip_force(*position, torques_nm_)) sample.force_n = *force;
  } else {
    before_.clear();
  }
  sample.buttons = message.buttons;
  sample.after_gap = std::exchange(after_gap_, false);
  ++counts_.samples;
  out.samples.emplace_back(sample);
  poll(sample.homed ? green : red, out);
}

}  // namespace fude
