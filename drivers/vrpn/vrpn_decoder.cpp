#include "drivers/vrpn/vrpn_decoder.h"

namespace fude {

using namespace vrpn;

std::vector<Transfer> VrpnDecoder::greeting() {
  Transfer transfer;
  transfer.direction = Direction::to_device;
  transfer.kind = TransferKind::message;
  transfer.payload = write_cookie();
  return {transfer};
}

void VrpnDecoder::decode(const Transfer& transfer, Decoded& out) {
  if (transfer.direction != Direction::from_device) return;
  if (transfer.kind == TransferKind::unplugged || transfer.kind == TransferKind::suspended) {
    senders_.clear();
    types_.clear();
    after_gap_ = true;
  }
  if (transfer.kind != TransferKind::message) return;
  if (is_cookie(transfer.payload)) {
    ++counts_.reports;
    return;
  }
  const auto message = read_message(transfer.payload);
  if (!message || !take(*message, transfer, out)) ++counts_.malformed;
}

bool VrpnDecoder::take(const Message& message, const Transfer& transfer, Decoded& out) {
  if (message.type == sender_description || message.type == type_description) {
    auto name = read_description(message.body);
    if (!name || message.sender < 0) return false;
    (message.type == sender_description ? senders_ : types_)[message.sender] = std::move(*name);
    ++counts_.reports;
    return true;
  }
  const auto type = types_.find(message.type);
  const auto sender = senders_.find(message.sender);
  const bool known = type != types_.end() && sender != senders_.end();
  if (!known || (type->second != pose_type && type->second != velocity_type)) {
    ++counts_.unknown;
    return true;
  }
  if (type->second == velocity_type) {
    counts_.reports += is_velocity(message.body);
    return is_velocity(message.body);
  }
  const auto pose = read_pose(message.body);
  if (!pose) return false;
  ++counts_.reports;
  PoseSample sample;
  sample.time = {transfer.time, transfer.stamped_by, sequence_++, message.time_us};
  sample.tool = pose->sensor == 0 ? sender->second : sender->second + "/" + std::to_string(pose->sensor);
  sample.tracker_from_tool = pose->pose;
  sample.after_gap = std::exchange(after_gap_, false);
  ++counts_.samples;
  out.samples.emplace_back(std::move(sample));
  return true;
}

}  // namespace fude
