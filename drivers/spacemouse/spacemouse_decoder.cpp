#include "drivers/spacemouse/spacemouse_decoder.h"

#include <utility>

namespace fude {

SpaceMouseDecoder::SpaceMouseDecoder(std::uint16_t vendor, std::uint16_t product)
    : model_(spacemouse::model_of(vendor, product)) {}

void SpaceMouseDecoder::decode(const Transfer& transfer, Decoded& out) {
  if (transfer.direction != Direction::from_device) return;
  if (transfer.kind == TransferKind::unplugged || transfer.kind == TransferKind::suspended) {
    state_ = {};
    after_gap_ = true;
    return;
  }
  if (transfer.kind != TransferKind::hid_report) return;
  const auto report = spacemouse::read_report(transfer.payload);
  if (!report) {
    const bool foreign = !transfer.payload.empty() && !spacemouse::knows(octet(transfer.payload, 0));
    ++(foreign ? counts_.unknown : counts_.malformed);
    return;
  }
  ++counts_.reports;
  const auto share = [this](const Eigen::Vector3i& counts) -> Eigen::Vector3d {
    return (counts.cast<double>() / model_.range_counts).cwiseMax(-1).cwiseMin(1);
  };
  if (report->push_counts) state_.push = share(*report->push_counts);
  if (report->turn_counts) state_.turn = share(*report->turn_counts);
  if (report->buttons) state_.buttons = *report->buttons & (0xffffffffu >> (32 - model_.buttons));
  if (!report->push_counts && !report->turn_counts && !report->buttons) return;
  PuckSample sample = state_;
  sample.time = {transfer.time, transfer.stamped_by, sequence_++, std::nullopt};
  sample.after_gap = std::exchange(after_gap_, false);
  ++counts_.samples;
  out.samples.emplace_back(sample);
}

}  // namespace fude
