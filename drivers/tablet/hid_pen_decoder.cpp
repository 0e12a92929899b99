#include "drivers/tablet/hid_pen_decoder.h"

#include <linux/input-event-codes.h>

#include <algorithm>

#include "drivers/tablet/hid_pen_uclogic.h"
#include "drivers/tablet/pen_axes.h"

namespace fude {
namespace {

using namespace hid_pen;

// A device of unknown make may be one of UC-Logic's: dumps of USB reports do not name it.
bool may_be_uclogic(const DeviceDescription& device) {
  return device.vendor == 0 || device.vendor == uclogic || device.vendor == huion;
}

void complete_axis(DeviceDescription& device, std::uint16_t code, std::int32_t minimum,
                   std::int32_t maximum) {
  if (find_axis(device, code) != nullptr) return;
  device.axes.push_back({.code = code, .minimum = minimum, .maximum = maximum});
  std::sort(device.axes.begin(), device.axes.end(),
            [](const AxisRange& a, const AxisRange& b) { return a.code < b.code; });
}

void complete_size(DeviceDescription& device, std::optional<double> width, std::optional<double> height) {
  if (!device.width && width) device.width = Millimetres(*width);
  if (!device.height && height) device.height = Millimetres(*height);
}

}  // namespace

std::optional<DeviceDescription> described_hid_pen(DeviceDescription device,
                                                   std::span<const Transfer> transfers) {
  const auto any_report = [&](auto is_pen) {
    return std::any_of(transfers.begin(), transfers.end(), [&](const Transfer& t) {
      return t.kind == TransferKind::hid_report && t.direction == Direction::from_device &&
             is_pen(Bytes(t.payload));
    });
  };
  const auto model = device.vendor == wacom ? wacom_model(device.product) : std::nullopt;
  const std::vector<StandardPen> standard = standard_pens(device.hid_descriptor);
  device.kind = DeviceKind::pen_tablet;
  if (model && any_report([&](Bytes report) {
        PenSample pen;
        return read_wacom(*model, report, pen) == PenReport::sample;
      })) {
    complete_axis(device, ABS_X, 0, model->across);
    complete_axis(device, ABS_Y, 0, model->down);
    complete_axis(device, ABS_PRESSURE, 0, model->pressure);
    complete_size(device, model->across / model->counts_per_mm, model->down / model->counts_per_mm);
    return device;
  }
  if (may_be_uclogic(device) && any_report(is_uclogic_pen_report)) {
    const bool with_tilt =
        any_report([](Bytes report) { return is_uclogic_pen_report(report) && report.size() == 12; });
    complete_axis(device, ABS_PRESSURE, 0, with_tilt ? uclogic_pressure : uclogic_short_pressure);
    const bool sized = find_axis(device, ABS_X) != nullptr && device.width && device.height;
    if (with_tilt && !sized && !device.mm_per_count) device.mm_per_count = 1 / uclogic_counts_per_mm;
    return device;
  }
  if (!standard.empty() && !model) {
    const StandardPen& pen = standard.front();
    complete_axis(device, ABS_X, pen.x.logical_minimum, pen.x.logical_maximum);
    complete_axis(device, ABS_Y, pen.y.logical_minimum, pen.y.logical_maximum);
    if (pen.pressure)
      complete_axis(device, ABS_PRESSURE, pen.pressure->logical_minimum, pen.pressure->logical_maximum);
    complete_size(device, hid::span_mm(pen.x), hid::span_mm(pen.y));
    return device;
  }
  return std::nullopt;
}

HidPenDecoder::HidPenDecoder(const DeviceDescription& device)
    : wacom_(device.vendor == wacom ? wacom_model(device.product) : std::nullopt),
      may_be_uclogic_(may_be_uclogic(device)) {
  if (!wacom_) standard_ = standard_pens(device.hid_descriptor);
  if (const AxisRange* pressure = find_axis(device, ABS_PRESSURE); pressure != nullptr)
    greatest_pressure_ = std::max(0, pressure->maximum);
}

PenReport HidPenDecoder::read(Bytes report) {
  if (wacom_) return read_wacom(*wacom_, report, pen_);
  if (may_be_uclogic_ && is_uclogic_pen_report(report)) {
    const std::int32_t stated = report.size() == 12 ? uclogic_pressure : uclogic_short_pressure;
    return read_uclogic(report, greatest_pressure_ > 0 ? greatest_pressure_ : stated, pen_);
  }
  PenReport best = standard_.empty() && may_be_uclogic_ ? read_uclogic(report, 1, pen_) : PenReport::unknown;
  for (const StandardPen& layout : standard_) {
    const PenReport taken = read_standard(layout, report, pen_);
    if (taken == PenReport::sample) return taken;
    if (taken == PenReport::malformed) best = taken;
  }
  return best;
}

void HidPenDecoder::decode(const Transfer& transfer, Decoded& out) {
  if (transfer.kind == TransferKind::unplugged || transfer.kind == TransferKind::suspended) {
    pen_ = {};
    after_gap_ = true;
  }
  if (transfer.kind != TransferKind::hid_report || transfer.direction != Direction::from_device) return;
  switch (read(transfer.payload)) {
    case PenReport::malformed:
      ++counts_.malformed;
      return;
    case PenReport::unknown:
      ++counts_.unknown;
      return;
    case PenReport::entered:
      ++counts_.reports;
      return;
    case PenReport::sample:
      break;
  }
  ++counts_.reports;
  ++counts_.samples;
  pen_.time = {transfer.time, transfer.stamped_by, sequence_++, std::nullopt};
  pen_.after_gap = std::exchange(after_gap_, false);
  out.samples.emplace_back(pen_);
}

}  // namespace fude
