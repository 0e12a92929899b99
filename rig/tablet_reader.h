// One thread that reads one device and decodes it.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <thread>

#include "drivers/tablet/pen_decoder.h"
#include "signal/byte_source.h"

namespace fude {

class TabletReader {
 public:
  // Called on the reader's thread for every transfer, with the sample made of it.
  using Heard = std::function<void(const Transfer&, const std::optional<PenSample>&)>;

  // Reads until the source is gone or the reader is stopped. `decoder` outlives the reader: it keeps
  // its state while the device is away.
  TabletReader(std::unique_ptr<ByteSource> source, PenDecoder& decoder, Heard heard);
  ~TabletReader();
  TabletReader(const TabletReader&) = delete;
  TabletReader& operator=(const TabletReader&) = delete;

  // Returns when the last call of `heard` is over. True if the source had gone by itself.
  bool stop();

 private:
  void serve();

  std::unique_ptr<ByteSource> source_;
  PenDecoder& decoder_;
  Heard heard_;
  std::atomic<bool> stopping_{false};
  std::atomic<bool> gone_{false};
  std::thread thread_;
};

}  // namespace fude
