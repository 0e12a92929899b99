// OpenIGTLink messages as they stand on the wire (firmware-notes/openigtlink.md): header, checksum, and
// where one ends. The protocol's own library believes the sizes inside a message; here each is checked.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/frame_stream.h"

namespace fude::openigtlink {

inline constexpr std::size_t header_length = 58;
inline constexpr std::size_t longest_message = 65536;

struct Message {
  std::string type;         // "TRANSFORM" …
  std::string device;       // as its maker names it
  std::uint64_t stamp = 0;  // seconds since 1970 in 1/2^32; 0: not stated
  Bytes content;            // without extended header and metadata
};

// For a stream: a message of a kind that carries poses is whole when its checksum holds, damaged when it
// does not; other kinds are foreign, up to 256 MiB.
FrameFit fit_message(Bytes bytes);

// Of one whole message, which it points into; none where a size, the version or the checksum is wrong.
std::optional<Message> read_message(Bytes bytes);

// Version 1, which every peer reads. Names are cut at 12 and 20 bytes.
std::vector<std::byte> write_message(std::string_view type, std::string_view device, std::uint64_t stamp,
                                     Bytes content);

// CRC-64 of ECMA-182: polynomial 0x42f0e1eba9ea3693, from zero, high bit first.
std::uint64_t checksum(Bytes bytes);

// A stamp in microseconds since 1970, and back (to the nearest 1/2^32 s).
std::uint64_t stamp_us(std::uint64_t stamp);
std::uint64_t stamp_of_us(std::uint64_t microseconds);

}  // namespace fude::openigtlink
