#include "capture/import/gzip.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <limits>

namespace fude {
namespace {

constexpr std::string_view magic = "\x1f\x8b";

struct Inflater {
  z_stream stream{};
  Inflater() = default;
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;
  ~Inflater() { inflateEnd(&stream); }
};

}  // namespace

bool is_gzip(std::string_view bytes) { return bytes.starts_with(magic); }

Result<std::string> unpack_gzip(std::string_view bytes) {
  if (bytes.size() > largest_import)
    return failure(Fault::unsupported, "the file is larger than 256 MiB; split the recording");
  Inflater inflater;
  z_stream& stream = inflater.stream;
  constexpr int gzip_only = 16 + MAX_WBITS;
  if (inflateInit2(&stream, gzip_only) != Z_OK)
    return failure(Fault::storage, "no memory to unpack the file; close other programs");
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());

  std::string text;
  std::array<char, 65536> block;
  bool whole = false;  // a member has just ended
  while (!whole || stream.avail_in > 0) {
    if (whole) {
      const auto* rest = reinterpret_cast<const char*>(stream.next_in);
      if (!is_gzip({rest, stream.avail_in})) break;  // trailing bytes, as gzip(1) ignores them
      inflateReset(&stream);
    }
    stream.next_out = reinterpret_cast<Bytef*>(block.data());
    stream.avail_out = static_cast<uInt>(block.size());
    const int status = inflate(&stream, Z_NO_FLUSH);
    text.append(block.data(), block.size() - stream.avail_out);
    if (text.size() > largest_import)
      return failure(Fault::unsupported, "the file unpacks to more than 256 MiB; split the recording");
    if (status == Z_BUF_ERROR)
      return failure(Fault::malformed, "the gzip file is cut short; copy it again from its source");
    if (status != Z_OK && status != Z_STREAM_END)
      return failure(Fault::malformed, "the gzip file is damaged; copy it again from its source");
    whole = status == Z_STREAM_END;
  }
  return text;
}

}  // namespace fude
