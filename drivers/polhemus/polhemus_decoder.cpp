#include "drivers/polhemus/polhemus_decoder.h"

#include <algorithm>
#include <string>
#include <utility>

namespace fude {
namespace {

using namespace polhemus;

struct Model {
  std::uint16_t product;
  Dialect dialect;
  unsigned stations;
  std::uint8_t in;
  std::uint8_t out;
};
constexpr Model models[] = {
#define POLHEMUS_MODEL(product, name, dialect, stations, in, out) \
  {product, Dialect::dialect, stations, in, out},
#include "drivers/polhemus/models.inl"
#undef POLHEMUS_MODEL
};

const Model& model_of(std::uint16_t product) {
  const Model* model = std::find_if(std::begin(models), std::end(models),
                                    [&](const Model& m) { return m.product == product; });
  return model == std::end(models) ? models[4] : *model;
}

PolhemusDecoder::Options options_for(std::uint16_t product, bool usb) {
  const Model& model = model_of(product);
  PolhemusDecoder::Options options{usual_layout(model.dialect), std::nullopt, std::nullopt};
  if (usb) options.usb_out = model.out;
  return options;
}

std::string listed(const std::vector<unsigned>& items) {
  std::string text;
  for (unsigned item : items) text += "," + std::to_string(item);
  return text + "\r";
}

// FASTRAK takes single letters at once; LIBERTY ends every command but P by a carriage return.
std::vector<std::string> commands(const Layout& layout) {
  if (layout.dialect == Dialect::fastrak) {
    std::vector<std::string> all{"c", "f", layout.centimetres ? "u" : "U"};
    for (int station = 1; station <= 4; ++station)
      all.push_back("O" + std::to_string(station) + listed(layout.items));
    all.emplace_back("C");
    return all;
  }
  return {"P", "F1\r", layout.centimetres ? "U1\r" : "U0\r", "O*" + listed(layout.items), "C\r"};
}

}  // namespace

PolhemusDecoder::PolhemusDecoder(Options options) : options_(std::move(options)) {}

PolhemusDecoder::PolhemusDecoder(std::uint16_t product, bool usb)
    : PolhemusDecoder(options_for(product, usb)) {}

std::vector<Transfer> PolhemusDecoder::greeting() {
  std::vector<Transfer> all;
  for (const std::string& command : commands(options_.layout)) {
    Transfer transfer;
    transfer.direction = Direction::to_device;
    transfer.kind = options_.usb_out ? TransferKind::usb_bulk : TransferKind::serial;
    transfer.endpoint = options_.usb_out.value_or(0);
    for (char c : command) transfer.payload.push_back(static_cast<std::byte>(c));
    all.push_back(std::move(transfer));
  }
  return all;
}

void PolhemusDecoder::decode(const Transfer& transfer, Decoded& out) {
  if (transfer.direction != Direction::from_device) return;
  if (transfer.kind == TransferKind::unplugged || transfer.kind == TransferKind::suspended) {
    stream_.forget();
    frame_.forget();
    time_ms_.forget();
    last_station_ = 0;
    gap_waits_ = ~0u;
    return;
  }
  if (transfer.kind != TransferKind::serial && transfer.kind != TransferKind::usb_bulk) return;
  counts_.malformed += stream_
                           .feed(
                               transfer.payload, longest_record,
                               [this](Bytes bytes) { return fit_record(bytes, options_.layout); },
                               [&](Bytes frame) {
                                 if (const auto record = read_record(frame, options_.layout))
                                   return take_record(*record, transfer, out);
                                 ++counts_.unknown;
                               })
                           .damaged;
}

// A cycle is all stations once: it begins with another frame number, or where there is none, with a
// station that is not later in the order.
void PolhemusDecoder::begin_cycle(const Record& record) {
  const bool first = last_station_ == 0;
  const auto lose = [this](std::uint64_t cycles) {
    counts_.lost += cycles;
    sequence_ += cycles;
    gap_waits_ = ~0u;
  };
  if (record.frame) {
    const std::uint64_t step = frame_.advance(*record.frame);
    if (step == 0 && !first) return;
    if (step >= 0x80000000u) {  // the tracker counts anew
      frame_.forget();
      frame_.advance(*record.frame);
      time_ms_.forget();
      lose(1);
    } else if (step > 1) {
      lose(step - 1);
    }
    ++sequence_;
  } else if (record.station <= last_station_ || first) {
    ++sequence_;
  }
}

void PolhemusDecoder::take_record(const Record& record, const Transfer& transfer, Decoded& out) {
  begin_cycle(record);
  last_station_ = record.station;
  ++counts_.reports;
  PoseSample sample;
  sample.time = {transfer.time, transfer.stamped_by, sequence_ - 1, std::nullopt};
  if (record.time_ms) {
    time_ms_.advance(*record.time_ms);
    sample.time.device_tick = time_ms_.value() * 1000;
  }
  sample.tool = std::to_string(record.station);
  sample.tracker_from_tool.rotation = record.rotation.value_or(Eigen::Quaterniond::Identity());
  sample.tracker_from_tool.translation = record.position_m.value_or(Eigen::Vector3d::Zero());
  sample.buttons = record.stylus.value_or(0);
  const bool distorted =
      options_.most_distortion && record.distortion.value_or(0) > *options_.most_distortion;
  sample.valid = !record.flagged && !distorted && record.position_m && record.rotation;
  const std::uint32_t bit = 1u << record.station;
  sample.after_gap = (gap_waits_ & bit) != 0;
  gap_waits_ &= ~bit;
  ++counts_.samples;
  out.samples.emplace_back(std::move(sample));
}

}  // namespace fude
