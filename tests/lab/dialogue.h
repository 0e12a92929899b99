// A family's driver and its device talking: greeting and replies are written, all that crosses is recorded.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "drivers/families.h"
#include "signal/byte_source.h"
#include "tests/lab/session_recording.h"

namespace fude::lab {

class Dialogue {
 public:
  // `numbered_here`: where the virtual host gives an endpoint another address than the device's maker did.
  Dialogue(ByteSource& source, const DeviceDescription& device,
           std::map<std::uint8_t, std::uint8_t> numbered_here = {})
      : source_(source),
        device_(device),
        numbered_here_(std::move(numbered_here)),
        decoder_(new_decoder()),
        recording_(device) {
    say(decoder_->greeting());
  }

  // Until there are `count` samples in all; false when the device says no more.
  bool hear(std::size_t count) {
    while (samples.size() < count)
      if (!hear_one()) return false;
    return true;
  }
  // One transfer. A device that has come back is greeted again.
  bool hear_one() {
    if (!recording_.drain_one(source_)) return false;
    const Transfer& transfer = recording_.last();
    Decoded out;
    decoder_->decode(transfer, out);
    samples.insert(samples.end(), out.samples.begin(), out.samples.end());
    if (transfer.kind == TransferKind::plugged && !samples.empty()) out.replies = decoder_->greeting();
    say(out.replies);
    return true;
  }

  const ReportCounts& counts() const { return decoder_->counts(); }
  const Transfer& last() const { return recording_.last(); }
  std::vector<Sample> samples;

  // Closes the session, and decodes what its file holds with a driver of its own.
  std::vector<Sample> again() {
    const auto decoder = new_decoder();
    Decoded out;
    for (const Transfer& transfer : recording_.finish()) decoder->decode(transfer, out);
    return out.samples;
  }

 private:
  std::unique_ptr<Decoder> new_decoder() const {
    const FamilyRow* row = find_family(device_);
    if (row == nullptr) throw std::runtime_error("no driver knows " + device_.id);
    return open_decoder(*row, device_);
  }

  void say(const std::vector<Transfer>& transfers) {
    for (Transfer transfer : transfers) {
      const auto here = numbered_here_.find(transfer.endpoint);
      if (here != numbered_here_.end()) transfer.endpoint = here->second;
      if (const auto written = source_.write(transfer); !written)
        throw std::runtime_error(written.error().message);
      recording_.add(transfer);
    }
  }

  ByteSource& source_;
  DeviceDescription device_;
  std::map<std::uint8_t, std::uint8_t> numbered_here_;
  std::unique_ptr<Decoder> decoder_;
  SessionRecording recording_;
};

}  // namespace fude::lab
