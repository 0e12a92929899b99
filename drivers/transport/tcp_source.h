// A peer on the network that one connects to, read in whole messages.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "drivers/frame_stream.h"
#include "drivers/transport/file_descriptor.h"
#include "drivers/transport/waker.h"
#include "signal/byte_source.h"
#include "signal/result.h"

namespace fude {

class TcpSource final : public ByteSource {
 public:
  struct Options {
    std::string host = "127.0.0.1";
    std::uint16_t port = 0;
    Duration connect_within = std::chrono::seconds(3);
    Duration write_within = std::chrono::seconds(1);
    std::size_t longest_message = 65536;
    std::function<FrameFit(Bytes)> fit;  // where a message ends: openigtlink::fit_message, vrpn::fit_message
  };

  // Errors: not_found where there is no such host, device_gone where nobody listens or answers in time.
  static Result<std::unique_ptr<TcpSource>> open(Options options);

  // Messages are stamped on arrival of their last byte. When the peer closes: one `unplugged`, then
  // device_gone; to connect again is the caller's business.
  Result<std::optional<Transfer>> read(std::optional<Timestamp> deadline) override;

  // Sends the payload as it is. Errors: device_gone also where the peer does not take it in time; the
  // connection is then over, as half a message may have gone.
  Result<void> write(const Transfer& transfer) override;

  void wake() override { waker_.wake(); }

  // Places in the stream that looked like a message and were none, and messages stepped over.
  FrameStream::Fed skipped() const { return skipped_; }

 private:
  TcpSource(Options options, FileDescriptor socket);
  void take_bytes();
  void closed();
  Error gone() const;

  Options options_;
  FileDescriptor socket_;
  Waker waker_;
  FrameStream stream_;
  FrameStream::Fed skipped_;
  std::deque<Transfer> ready_;
  bool gone_ = false;
};

}  // namespace fude
