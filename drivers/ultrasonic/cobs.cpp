#include "drivers/ultrasonic/cobs.h"

namespace fude::ultrasonic {
namespace {

constexpr std::size_t longest_run = 254;

}  // namespace

std::vector<std::byte> stuffed(Bytes packet) {
  std::vector<std::byte> out{std::byte{1}};
  std::size_t code = 0;  // where the length of the current run stands
  const auto begin_run = [&] {
    code = out.size();
    out.push_back(std::byte{1});
  };
  for (std::size_t i = 0; i < packet.size(); ++i) {
    if (packet[i] == std::byte{0}) {
      begin_run();
      continue;
    }
    out.push_back(packet[i]);
    out[code] = static_cast<std::byte>(out.size() - code);
    if (out.size() - code > longest_run && i + 1 < packet.size()) begin_run();
  }
  return out;
}

std::optional<std::vector<std::byte>> unstuffed(Bytes bytes) {
  std::vector<std::byte> packet;
  std::size_t at = 0;
  while (at < bytes.size()) {
    const std::size_t code = octet(bytes, at);
    if (code == 0 || at + code > bytes.size()) return std::nullopt;
    append(packet, bytes.subspan(at + 1, code - 1));
    at += code;
    if (code <= longest_run && at < bytes.size()) packet.push_back(std::byte{0});
  }
  return packet;
}

}  // namespace fude::ultrasonic
