// Any bytes through every importer: a recording or one line of complaint. Events and reports never go back in time;
// samples are finite and in range.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "capture/import/images.h"
#include "capture/import/import.h"
#include "capture/import/usbhid_dump.h"

namespace {

using namespace fude;

void expect(bool holds) {
  if (!holds) __builtin_trap();
}

void check(const PenSample& pen) {
  expect(std::isfinite(pen.x_counts) && std::isfinite(pen.y_counts));
  expect(pen.pressure.value >= 0 && pen.pressure.value <= 1);
  for (const auto& angle : {pen.tilt_x, pen.tilt_y})
    if (angle) expect(std::abs(angle->value) < 1.6);
}
void check(const ImuSample& imu) {
  expect(imu.turn_rate_radps.allFinite() && imu.specific_force_mps2.allFinite());
}
void check(const PoseSample& pose) {
  expect(pose.tracker_from_tool.translation.allFinite());
  expect(std::abs(pose.tracker_from_tool.rotation.norm() - 1) < 1e-9);
}
void check(const CameraFrame& frame) { expect(frame.width > 0 && frame.height > 0); }
template <class S>
void check(const S&) {}

void check(const Result<ImportedFile>& imported) {
  if (!imported) {
    expect(!imported.error().message.empty() && imported.error().message.find('\n') == std::string::npos);
    return;
  }
  for (const RawRecording& recording : imported->recordings) {
    Timestamp before{};
    for (const Transfer& transfer : recording.transfers) {
      expect(transfer.time >= before);
      if (transfer.kind == TransferKind::evdev_frame) expect(unpack_events(transfer.payload).has_value());
      before = transfer.time;
    }
    for (const Sample& sample : recording.samples) std::visit([](const auto& s) { check(s); }, sample);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(bytes), size);
  ImportOptions options;
  check(import_bytes(text, options));
  options.rate_hz = 100;
  for (const std::string& name : import_format_names()) {
    options.format = import_format(name);
    check(import_bytes(text, options));
  }
  if (const auto head = picture_head(std::as_bytes(std::span(bytes, size)))) expect(head->width > 0);
  (void)read_tablet_page(text);
  return 0;
}
