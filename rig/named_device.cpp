#include "rig/named_device.h"

#include <charconv>
#include <cstdint>
#include <string_view>

#include "drivers/openigtlink/message.h"
#include "drivers/transport/serial_source.h"
#include "drivers/transport/tcp_source.h"
#include "drivers/vrpn/message.h"

namespace fude {
namespace {

constexpr int usual_baud = 115200;

Error unreadable(const std::string& text) {
  std::string words;
  for (const FamilyRow& row : family_rows())
    if (row.vendor == 0 && std::string_view(row.transport) != "evdev")
      words += (words.empty() ? "" : ", ") + std::string(row.word);
  return {Fault::usage,
          "'" + text + "' names no device; give WORD:NODE[@BAUD] or WORD:HOST[:PORT], WORD one of " + words};
}

template <class Number>
bool read_number(std::string_view digits, Number& number) {
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  return error == std::errc{} && end == digits.data() + digits.size() && number > 0;
}

Result<std::unique_ptr<ByteSource>> open_serial(const std::string& node, int baud) {
  auto source = SerialSource::open(node, baud);
  if (!source) return tl::unexpected(source.error());
  return std::unique_ptr<ByteSource>(std::move(*source));
}

Result<std::unique_ptr<ByteSource>> open_peer(const TcpSource::Options& options) {
  auto source = TcpSource::open(options);
  if (!source) return tl::unexpected(source.error());
  return std::unique_ptr<ByteSource>(std::move(*source));
}

}  // namespace

Result<NamedDevice> named_device(const std::string& text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos || colon + 1 == text.size()) return tl::unexpected(unreadable(text));
  const std::string word = text.substr(0, colon);
  std::string where = text.substr(colon + 1);
  NamedDevice named;
  DeviceDescription& device = named.description;
  device.clock = DeviceClock{.nominal_tick = 1e-6};
  if ((named.family = find_family(word, "serial")) != nullptr) {
    int baud = usual_baud;
    if (const std::size_t at = where.rfind('@'); at != std::string::npos) {
      if (!read_number(std::string_view(where).substr(at + 1), baud)) return tl::unexpected(unreadable(text));
      where.resize(at);
    }
    device.serial = where;
    named.open = [where, baud] { return open_serial(where, baud); };
  } else if ((named.family = find_family(word, "network")) != nullptr) {
    const bool igtl = named.family->family == Family::openigtlink;
    TcpSource::Options options;
    options.port = igtl ? 18944 : 3883;
    options.fit = igtl ? openigtlink::fit_message : vrpn::fit_message;
    if (const std::size_t at = where.rfind(':'); at != std::string::npos) {
      if (!read_number(std::string_view(where).substr(at + 1), options.port))
        return tl::unexpected(unreadable(text));
      where.resize(at);
    }
    options.host = where;
    device.serial = where + ":" + std::to_string(options.port);
    named.open = [options] { return open_peer(options); };
  } else {
    return tl::unexpected(unreadable(text));
  }
  device.name = name_at(*named.family, device.serial);
  device.kind = named.family->kind;
  device.transport = named.family->transport;
  device.id = device_id(device);
  return named;
}

}  // namespace fude
