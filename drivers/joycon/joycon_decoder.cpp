#include "drivers/joycon/joycon_decoder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "drivers/joycon/rail.h"

namespace fude {
namespace {

using namespace joycon;

constexpr Duration timer_period = std::chrono::milliseconds(5);
constexpr std::uint64_t microseconds_per_tick = 5000;
constexpr Duration patience = std::chrono::milliseconds(500);
constexpr int most_repeats = 4;

constexpr std::uint8_t read_flash = 0x10;
constexpr std::uint32_t factory_calibration = 0x6020;
constexpr std::uint32_t user_calibration = 0x8026;  // two bytes b2 a1 where there is one, then the same 24
constexpr std::uint8_t user_calibration_length = 2 + calibration_length;

struct Question {
  std::uint8_t subcommand;
  std::vector<std::byte> arguments;
};

const std::vector<Question>& questions() {
  static const std::vector<Question> all{
      {0x40, octets({0x01})},
      {read_flash, flash_question(factory_calibration, calibration_length)},
      {read_flash, flash_question(user_calibration, user_calibration_length)},
      {0x03, octets({0x30})}};
  return all;
}

bool saturated(const InertialCounts& counts) {
  const auto at_end = [](std::int16_t axis) {
    return axis == std::numeric_limits<std::int16_t>::min() ||
           axis == std::numeric_limits<std::int16_t>::max();
  };
  return std::any_of(counts.acceleration.begin(), counts.acceleration.end(), at_end) ||
         std::any_of(counts.turn_rate.begin(), counts.turn_rate.end(), at_end);
}

// A unit that is switched off sends zeros; gravity never does.
bool silent(const InertialCounts& counts) { return counts.acceleration == std::array<std::int16_t, 3>{}; }

}  // namespace

JoyconDecoder::JoyconDecoder(std::uint16_t product)
    : nominal_(nominal_scale(product)), scale_(nominal_), question_(questions().size()) {}

std::vector<Transfer> JoyconDecoder::greeting() {
  std::vector<Transfer> first;
  repeats_ = 0;
  ask(0, nullptr, first);
  return first;
}

void JoyconDecoder::ask(std::size_t question, const Transfer* cause, std::vector<Transfer>& out) {
  question_ = question;
  asked_.reset();
  if (question == questions().size()) return;
  if (cause != nullptr) asked_ = cause->time;
  Transfer transfer;
  if (cause != nullptr) transfer.time = cause->time;
  transfer.direction = Direction::to_device;
  transfer.kind = TransferKind::hid_report;
  transfer.payload = subcommand(packet_++, questions()[question].subcommand, questions()[question].arguments);
  flash_asked_ = flash_asked_ || questions()[question].subcommand == read_flash;
  out.push_back(std::move(transfer));
}

void JoyconDecoder::ask_again_if_late(const Transfer& transfer, Decoded& out) {
  if (question_ == questions().size()) return;
  if (!asked_) asked_ = transfer.time;
  if (transfer.time - *asked_ < patience) return;
  if (++repeats_ <= most_repeats) return ask(question_, &transfer, out.replies);
  repeats_ = 0;
  ask(question_ + 1, &transfer, out.replies);
}

void JoyconDecoder::decode(const Transfer& transfer, Decoded& out) {
  if (transfer.direction != Direction::from_device) {
    flash_asked_ =
        flash_asked_ || (transfer.kind == TransferKind::hid_report && transfer.payload.size() > 10 &&
                         octet(transfer.payload, 0) == 0x01 && octet(transfer.payload, 10) == read_flash);
    return;
  }
  switch (transfer.kind) {
    case TransferKind::unplugged:
    case TransferKind::suspended:
      return forget();
    case TransferKind::hid_report:
      return take_report(transfer.payload, transfer, out);
    case TransferKind::serial:
      counts_.malformed += rail_
                               .feed(transfer.payload, longest_rail_packet, fit_rail_packet,
                                     [&](Bytes packet) {
                                       if (const Bytes report = rail_report(packet); !report.empty())
                                         return take_report(report, transfer, out);
                                       ++counts_.unknown;
                                     })
                               .damaged;
      return;
    default:
      return;
  }
}

void JoyconDecoder::take_report(Bytes report, const Transfer& transfer, Decoded& out) {
  switch (kind_of(report)) {
    case ReportKind::full:
      if (const auto full = read_full_report(report))
        take_full(*full, transfer, out);
      else
        ++counts_.malformed;
      break;
    case ReportKind::reply:
      if (const auto reply = read_reply(report))
        take_reply(*reply, transfer, out);
      else
        ++counts_.malformed;
      break;
    case ReportKind::simple:  // buttons alone, before the device has been asked for full reports
      ++(report.size() >= 12 ? counts_.reports : counts_.malformed);
      break;
    case ReportKind::other:
      ++(report.empty() ? counts_.malformed : counts_.unknown);
      break;
  }
  ask_again_if_late(transfer, out);
}

// The timer goes round in 1.28 s; whole turns in a longer silence are told by the host's clock.
std::uint64_t JoyconDecoder::advance_timer(std::uint8_t timer, const Transfer& transfer) {
  const bool first = !timer_.started();
  std::uint64_t step = timer_.advance(timer);
  if (!first) {
    const double passed = static_cast<double>((transfer.time - last_report_).count()) / timer_period.count();
    const double turns = std::round((passed - static_cast<double>(step)) / 256);
    if (turns > 0 && turns < 1e9) {
      timer_.add_turns(static_cast<std::uint64_t>(turns));
      step += static_cast<std::uint64_t>(turns) << 8;
    }
  }
  last_report_ = transfer.time;
  return step;
}

// Reports are three counts of the timer apart, two or four when it jitters.
void JoyconDecoder::take_full(const FullReport& full, const Transfer& transfer, Decoded& out) {
  const auto reports_in = [](std::uint64_t step) { return (step + 1) / samples_per_report; };
  ++counts_.reports;
  const std::uint64_t step = advance_timer(full.head.timer, transfer);
  if (reports_in(step) > 1) counts_.lost += reports_in(step) - 1;

  const std::uint64_t newest = timer_.value();
  if (last_full_ && reports_in(newest - *last_full_) > 1) {
    sequence_ += samples_per_report * (reports_in(newest - *last_full_) - 1);
    after_gap_ = true;
  }
  last_full_ = newest;

  for (std::size_t i = 0; i < samples_per_report; ++i) {
    const InertialCounts& counts = full.samples[i];
    // The first report's older samples may lie before the timer's zero: one turn is put in front.
    const std::uint64_t tick = newest + 256 - (samples_per_report - 1 - i);
    ImuSample sample;
    sample.time = {transfer.time, transfer.stamped_by, sequence_++, tick * microseconds_per_tick};
    sample.turn_rate_radps = scale_.turn_rate_of(counts);
    sample.specific_force_mps2 = scale_.specific_force_mps2(counts);
    sample.buttons = full.head.buttons;
    sample.battery = Fraction(full.head.battery);
    sample.saturated = saturated(counts);
    sample.valid = !silent(counts);
    sample.after_gap = std::exchange(after_gap_, false);
    ++counts_.samples;
    out.samples.emplace_back(sample);
  }
}

void JoyconDecoder::take_reply(const Reply& reply, const Transfer& transfer, Decoded& out) {
  ++counts_.reports;
  const std::uint64_t step = advance_timer(reply.head.timer, transfer);
  if ((step + 1) / samples_per_report > 1) counts_.lost += (step + 1) / samples_per_report - 1;

  if (flash_asked_) take_flash(reply);
  if (question_ == questions().size() || reply.subcommand != questions()[question_].subcommand) return;
  const auto& arguments = questions()[question_].arguments;
  const bool other_flash = reply.acknowledged && reply.subcommand == read_flash &&
                           !std::equal(arguments.begin(), arguments.end(), reply.data.begin());
  if (other_flash) return;  // the answer to a question that was asked twice
  repeats_ = 0;
  ask(question_ + 1, &transfer, out.replies);
}

void JoyconDecoder::take_flash(const Reply& reply) {
  if (const auto flash = flash_answer(reply, factory_calibration, calibration_length)) {
    if (const auto scale = read_calibration(*flash)) {
      scale_ = *scale;
      calibrated_ = true;
    }
  } else if (const auto user = flash_answer(reply, user_calibration, user_calibration_length)) {
    const bool marked = octet(*user, 0) == 0xb2 && octet(*user, 1) == 0xa1;
    if (const auto scale = read_calibration(user->subspan(2)); marked && scale) {
      scale_ = *scale;
      calibrated_ = true;
    }
  }
}

void JoyconDecoder::forget() {
  rail_.forget();
  timer_.forget();
  last_full_.reset();
  scale_ = nominal_;
  calibrated_ = false;
  flash_asked_ = false;
  question_ = questions().size();
  after_gap_ = true;
}

}  // namespace fude
