// One device, read on a thread of its own: what it sends is decoded, and what its driver answers is sent.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <span>
#include <thread>

#include "drivers/decoder.h"
#include "signal/byte_source.h"

namespace fude {

class DeviceReader {
 public:
  // Each transfer of either direction in its order, with the samples that the driver made of it.
  using Heard = std::function<void(const Transfer&, std::span<const Sample>)>;

  // `heard` is called on the reading thread only. The driver's greeting is sent first, and again whenever
  // the source says that the device is back. `decoder` must outlive the reader.
  DeviceReader(std::unique_ptr<ByteSource> source, Decoder& decoder, Heard heard);
  ~DeviceReader();  // stops
  DeviceReader(const DeviceReader&) = delete;
  DeviceReader& operator=(const DeviceReader&) = delete;

  // Whether the device had gone by itself.
  bool stop();

 private:
  void serve();
  void send(const std::vector<Transfer>& transfers);

  std::unique_ptr<ByteSource> source_;
  Decoder& decoder_;
  Heard heard_;
  std::atomic<bool> stopping_{false};
  std::atomic<bool> gone_{false};
  std::thread thread_;
};

}  // namespace fude
