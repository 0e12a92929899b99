#include "drivers/openigtlink/openigtlink_decoder.h"

#include <optional>
#include <string>
#include <utility>

#include "drivers/openigtlink/content.h"

namespace fude {

using namespace openigtlink;

void OpenIgtLinkDecoder::decode(const Transfer& transfer, Decoded& out) {
  if (transfer.direction != Direction::from_device) return;
  if (transfer.kind == TransferKind::unplugged || transfer.kind == TransferKind::suspended) after_gap_ = true;
  if (transfer.kind != TransferKind::message) return;
  const auto message = read_message(transfer.payload);
  if (!message || !take(*message, transfer, out)) ++counts_.malformed;
}

bool OpenIgtLinkDecoder::take(const Message& message, const Transfer& transfer, Decoded& out) {
  SampleTime time{transfer.time, transfer.stamped_by, sequence_, std::nullopt};
  if (message.stamp != 0) time.device_tick = stamp_us(message.stamp);
  std::size_t made = 0;
  const auto add = [&](auto sample) {
    sample.time = time;
    sample.after_gap = after_gap_;
    out.samples.emplace_back(std::move(sample));
    ++made;
  };
  const auto add_pose = [&](const std::string& name, const ToolPose& pose) {
    PoseSample sample;
    sample.tool = name;
    sample.tracker_from_tool = pose;
    add(std::move(sample));
  };
  const auto add_tools = [&](const std::optional<Tools>& tools) {
    if (!tools) return false;
    counts_.malformed += tools->refused;
    for (const NamedPose& tool : tools->poses) add_pose(tool.name, tool.pose);
    return true;
  };

  bool stands = false;
  if (message.type == "TRANSFORM") {
    const auto pose = read_transform(message.content);
    if (pose) add_pose(message.device, *pose);
    stands = pose.has_value();
  } else if (message.type == "TDATA") {
    stands = add_tools(read_tdata(message.content));
  } else if (message.type == "QTDATA") {
    stands = add_tools(read_qtdata(message.content));
  } else if (message.type == "POSITION" || message.type == "QTRANS") {
    const auto place = read_position(message.content);
    if (place && place->rotation) {
      add_pose(message.device, {*place->rotation, place->position_m});
    } else if (place) {
      PositionSample sample;
      sample.marker = message.device;
      sample.tracker_from_marker_m = place->position_m;
      add(std::move(sample));
    }
    stands = place.has_value();
  } else if (message.type == "STATUS") {
    stands = read_status(message.content).has_value();
  } else {
    ++counts_.unknown;
    return true;
  }
  if (!stands) return false;
  ++counts_.reports;
  counts_.samples += made;
  if (made > 0) {
    ++sequence_;
    after_gap_ = false;
  }
  return true;
}

}  // namespace fude
