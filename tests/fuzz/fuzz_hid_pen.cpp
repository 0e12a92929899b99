// Any report descriptor and any reports: fields inside the report, pens in range, every report counted. The input is
// vendor (2 bytes), product (2), the descriptor's length (2), the descriptor, then reports behind their length (1).
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "drivers/tablet/hid_pen_decoder.h"

namespace {

using namespace fude;

void expect(bool holds) {
  if (!holds) __builtin_trap();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const Bytes input = std::as_bytes(std::span(data, size));
  if (input.size() < 6) return 0;
  DeviceDescription device;
  device.vendor = little_endian<std::uint16_t>(input, 0);
  device.product = little_endian<std::uint16_t>(input, 2);
  const std::size_t length = std::min<std::size_t>(little_endian<std::uint16_t>(input, 4), input.size() - 6);
  const Bytes descriptor = input.subspan(6, length);
  device.hid_descriptor.assign(descriptor.begin(), descriptor.end());
  if (const auto parsed = hid::parse_descriptor(descriptor))
    for (const hid::Field& field : parsed->inputs) expect(field.bits >= 1 && field.bits <= 32);

  std::vector<Transfer> reports;
  for (Bytes rest = input.subspan(6 + length); !rest.empty();) {
    const std::size_t bytes = std::min<std::size_t>(octet(rest, 0), rest.size() - 1);
    Transfer& transfer = reports.emplace_back();
    transfer.kind = TransferKind::hid_report;
    transfer.payload.assign(rest.begin() + 1, rest.begin() + 1 + static_cast<std::ptrdiff_t>(bytes));
    rest = rest.subspan(bytes + 1);
  }
  const auto described = described_hid_pen(device, reports);
  HidPenDecoder decoder(described ? *described : device);
  Decoded out;
  for (const Transfer& transfer : reports) decoder.decode(transfer, out);
  const ReportCounts& counts = decoder.counts();
  expect(counts.reports + counts.malformed + counts.unknown == reports.size());
  expect(counts.samples == out.samples.size());
  for (const Sample& sample : out.samples) {
    const auto& pen = std::get<PenSample>(sample);
    expect(std::isfinite(pen.x_counts) && std::isfinite(pen.y_counts));
    expect(pen.pressure.value >= 0 && pen.pressure.value <= 1);
    for (const auto& angle : {pen.tilt_x, pen.tilt_y})
      if (angle) expect(std::abs(angle->value) < 1.6);
    if (pen.rotation) expect(std::abs(pen.rotation->value) < 3.2);
    expect(pen.in_proximity == (pen.tool != PenTool::none));
    expect(pen.in_proximity || !pen.in_contact);
  }
  return 0;
}
