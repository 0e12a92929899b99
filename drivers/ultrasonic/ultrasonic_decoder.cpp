#include "drivers/ultrasonic/ultrasonic_decoder.h"

#include "drivers/ultrasonic/cobs.h"

namespace fude {

using namespace ultrasonic;

std::vector<Transfer> UltrasonicDecoder::greeting() {
  Transfer transfer;
  transfer.direction = Direction::to_device;
  transfer.kind = TransferKind::serial;
  transfer.payload = octets({0});
  append(transfer.payload, framed(write_command(PacketKind::describe)));
  append(transfer.payload, framed(write_command(PacketKind::start)));
  return {transfer};
}

void UltrasonicDecoder::decode(const Transfer& transfer, Decoded& out) {
  if (transfer.direction != Direction::from_device) return;
  if (transfer.kind == TransferKind::unplugged || transfer.kind == TransferKind::suspended) {
    line_.clear();
    overflowed_ = false;
    board_.reset();
    stream_.interrupted();
    return;
  }
  if (transfer.kind != TransferKind::serial) return;
  for (std::byte byte : transfer.payload) {
    if (byte != std::byte{0}) {
      if (line_.size() < longest_packet + 1)
        line_.push_back(byte);
      else
        overflowed_ = true;
      continue;
    }
    const auto packet = overflowed_ ? std::nullopt : unstuffed(line_);
    if (packet && !packet->empty())
      take_packet(*packet, transfer, out);
    else if (!line_.empty())
      ++counts_.malformed;
    line_.clear();
    overflowed_ = false;
  }
}

void UltrasonicDecoder::take_packet(Bytes packet, const Transfer& transfer, Decoded& out) {
  const auto kind = kind_of(packet);
  if (kind == PacketKind::pulse) {
    if (const auto pulse = read_pulse(packet)) return take_pulse(*pulse, transfer, out);
  } else if (kind == PacketKind::board) {
    if ((board_ = read_board(packet))) {
      ++counts_.reports;
      return;
    }
  } else if (kind) {
    ++counts_.unknown;
    return;
  }
  ++counts_.malformed;
}

void UltrasonicDecoder::take_pulse(const Pulse& pulse, const Transfer& transfer, Decoded& out) {
  const auto place = stream_.place(pulse.sequence, pulse.tick_us, transfer.time);
  if (place.repeated) {
    ++counts_.malformed;
    return;
  }
  ++counts_.reports;
  counts_.lost += place.lost;
  RangeSample sample;
  sample.time = {transfer.time, transfer.stamped_by, place.sequence, place.tick_us};
  sample.emitter = pulse.emitter;
  sample.receivers = pulse.receivers;
  for (std::size_t i = 0; i < pulse.receivers; ++i) {
    if (pulse.flight_ns[i]) sample.flight_s[i] = *pulse.flight_ns[i] * 1e-9;
    sample.amplitude[i] = pulse.amplitude[i] / 65535.0;
  }
  sample.temperature_c = pulse.temperature_c;
  sample.after_gap = place.after_gap;
  ++counts_.samples;
  out.samples.emplace_back(sample);
}

}  // namespace fude
