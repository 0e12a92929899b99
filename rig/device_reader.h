// One device, read on a thread of its own.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <span>
#include <thread>

#include "drivers/decoder.h"
#include "signal/byte_source.h"

namespace fude {

class Reader {
 public:
  // Each transfer of either direction in its order, with the samples that the driver made of it; called on
  // the reading thread only.
  using Heard = std::function<void(const Transfer&, std::span<const Sample>)>;

  virtual ~Reader() = default;

  // Whether the device had gone by itself.
  virtual bool stop() = 0;
};

// Waits for what the device sends, decodes it, and sends what its driver answers.
class DeviceReader final : public Reader {
 public:
  // The driver's greeting is sent first, and again whenever the source says that the device is back.
  // `decoder` must outlive the reader.
  DeviceReader(std::unique_ptr<ByteSource> source, Decoder& decoder, Heard heard);
  ~DeviceReader() override;  // stops
  DeviceReader(const DeviceReader&) = delete;
  DeviceReader& operator=(const DeviceReader&) = delete;

  bool stop() override;

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
