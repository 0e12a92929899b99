#include "rig/session_identity.h"

#include <nettle/sha2.h>

#include <array>
#include <bit>

#include "capture/sample_columns.h"

namespace fude {
namespace {

class Digest {
 public:
  Digest() { sha256_init(&state_); }
  void add(std::string_view text) {
    add(static_cast<std::int64_t>(text.size()));
    sha256_update(&state_, text.size(), reinterpret_cast<const std::uint8_t*>(text.data()));
  }
  void add(std::int64_t number) {
    std::array<std::uint8_t, 8> bytes{};
    for (std::size_t i = 0; i < 8; ++i)
      bytes[i] = static_cast<std::uint8_t>(static_cast<std::uint64_t>(number) >> (8 * i));
    sha256_update(&state_, bytes.size(), bytes.data());
  }
  void add(const Sample& sample) {
    for (const SampleColumn& column : sample_tables()[sample.index()].columns) {
      const Cell cell = column.get(sample);
      if (const auto* whole = std::get_if<std::int64_t>(&cell)) add(*whole);
      if (const auto* real = std::get_if<double>(&cell)) add(std::bit_cast<std::int64_t>(*real));
      if (const auto* text = std::get_if<std::string>(&cell)) add(std::string_view(*text));
    }
  }
  std::string hex() {
    std::array<std::uint8_t, SHA256_DIGEST_SIZE> digest{};
    sha256_digest(&state_, digest.size(), digest.data());
    std::string text;
    for (const std::uint8_t byte : digest) {
      text += "0123456789abcdef"[byte >> 4];
      text += "0123456789abcdef"[byte & 15];
    }
    return text;
  }

 private:
  sha256_ctx state_;
};

}  // namespace

std::string session_identity(const Session& session) {
  Digest digest;
  for (const RecordedDevice& device : session.devices) digest.add(std::string_view(device.description.id));
  for (const RecordedTransfer& t : session.transfers) {
    digest.add(std::int64_t{t.transfer.time.time_since_epoch().count()});
    digest.add(std::string_view(reinterpret_cast<const char*>(t.transfer.payload.data()),
                                t.transfer.payload.size()));
  }
  for (const RecordedPen& pen : session.pens) digest.add(Sample(pen.sample));
  for (const RecordedSample& s : session.samples) digest.add(s.sample);
  return digest.hex();
}

}  // namespace fude
