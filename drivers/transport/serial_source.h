// A serial port, read byte by byte as it comes (libserialport).
#pragma once

#include <libserialport.h>

#include <filesystem>
#include <memory>
#include <optional>

#include "drivers/transport/inbox.h"
#include "signal/byte_source.h"

namespace fude {

class SerialSource final : public ByteSource {
 public:
  // Opens e.g. /dev/ttyACM0 at `baud`, eight bits, no parity, one stop bit, no flow control, for this program
  // alone. Errors: not_found, no_access and busy as open_alone() has them; unsupported for a speed that the
  // port does not have.
  static Result<std::unique_ptr<SerialSource>> open(const std::filesystem::path& node, int baud);

  // One transfer `serial` of whatever has come, stamped on arrival.
  Result<std::optional<Transfer>> read(std::optional<Timestamp> deadline) override;

  // Kind serial. Errors: busy when the port has not taken all of it within a second.
  Result<void> write(const Transfer& transfer) override;
  void wake() override { inbox_.wake(); }

 private:
  struct Close {
    void operator()(sp_port* port) const;
  };
  using Port = std::unique_ptr<sp_port, Close>;
  SerialSource(Port port, int file, std::filesystem::path node);

  void take_bytes(bool hung_up);

  Port port_;
  int file_;  // the port's own
  std::filesystem::path node_;
  Inbox inbox_;
  bool gone_ = false;
};

}  // namespace fude
