#include "capture/picture/quick_deflate.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <queue>
#include <utility>

namespace fude {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::size_t block_bytes = 1 << 18;
constexpr std::size_t group = 8;  // bytes that are looked at together; a run is of whole groups
constexpr std::size_t longest_run = 256;

constexpr int end_of_block = 256;
constexpr int symbols = 286;  // bytes, the end, lengths of runs
constexpr int longest_code = 15, longest_length_code = 7;

struct Code {
  std::uint16_t bits = 0;  // the first in the lowest
  std::uint8_t length = 0;
};

// Lengths of Huffman's codes. Counts are made more alike until no code is too long, which costs next to
// nothing.
template <std::size_t N>
std::array<std::uint8_t, N> code_lengths(std::array<std::uint32_t, N> counts, int longest) {
  struct Node {
    std::uint32_t count;
    int number;
    bool operator<(const Node& other) const {
      return std::pair(count, number) > std::pair(other.count, other.number);
    }
  };
  // A code needs two symbols.
  for (std::size_t i = 0; std::ranges::count_if(counts, [](auto c) { return c > 0; }) < 2; ++i)
    counts[i] = std::max(counts[i], 1U);
  for (;;) {
    std::array<int, 2 * N> parent{};
    std::array<std::uint8_t, 2 * N> depth{};
    std::priority_queue<Node> open;
    for (std::size_t i = 0; i < N; ++i)
      if (counts[i] > 0) open.push({counts[i], static_cast<int>(i)});
    int next = N;
    while (open.size() > 1) {
      const Node a = open.top();
      open.pop();
      const Node b = open.top();
      open.pop();
      parent[static_cast<std::size_t>(a.number)] = parent[static_cast<std::size_t>(b.number)] = next;
      open.push({a.count + b.count, next++});
    }
    int deepest = 0;
    for (int n = next - 2; n >= 0; --n) {
      const auto at = static_cast<std::size_t>(n);
      if (n < static_cast<int>(N) && counts[at] == 0) continue;
      depth[at] = static_cast<std::uint8_t>(depth[static_cast<std::size_t>(parent[at])] + 1);
      deepest = std::max(deepest, int{depth[at]});
    }
    if (deepest <= longest) {
      std::array<std::uint8_t, N> lengths{};
      std::copy_n(depth.begin(), N, lengths.begin());
      return lengths;
    }
    for (std::uint32_t& count : counts) count = (count + 1) / 2;
  }
}

// RFC 1951, 3.2.2.
template <std::size_t N>
std::array<Code, N> codes_of(const std::array<std::uint8_t, N>& lengths) {
  std::array<std::uint32_t, longest_code + 2> first{};
  for (const std::uint8_t length : lengths)
    if (length > 0) ++first[length + 1U];
  for (std::size_t n = 1; n < first.size(); ++n) first[n] += first[n - 1];
  std::array<std::uint32_t, longest_code + 1> next{};
  std::uint32_t code = 0;
  for (std::size_t n = 1; n <= longest_code; ++n) {
    next[n] = code;
    code = (code + first[n + 1] - first[n]) << 1;
  }
  std::array<Code, N> codes{};
  for (std::size_t i = 0; i < N; ++i) {
    codes[i].length = lengths[i];
    if (lengths[i] == 0) continue;
    std::uint32_t forward = next[lengths[i]]++;
    for (int bit = 0; bit < lengths[i]; ++bit, forward >>= 1)
      codes[i].bits = static_cast<std::uint16_t>(codes[i].bits << 1 | (forward & 1));
  }
  return codes;
}

// The code of a run's length and what follows it: RFC 1951, 3.2.5, for 8 to 256.
struct RunLength {
  int symbol = 0;
  int extra_bits = 0;
  std::uint32_t extra = 0;
};
RunLength run_length(std::size_t length) {
  const auto over = static_cast<std::uint32_t>(length - 3);
  const int extra_bits = std::bit_width(over) - 3;
  return {257 + 4 * extra_bits + static_cast<int>(over >> extra_bits), extra_bits,
          over & ((1U << extra_bits) - 1)};
}

class BitWriter {
 public:
  explicit BitWriter(std::vector<std::byte>& out) : out_(out) {}

  // At most so many bytes follow until the next call.
  void reserve(std::size_t bytes) {
    out_.resize(size_ + bytes + sizeof bits_);
    at_ = out_.data();
  }
  // Up to 56 bits between two calls of flush().
  void put(std::uint32_t bits, int length) {
    bits_ |= std::uint64_t{bits} << held_;
    held_ += length;
  }
  void put(Code code) { put(code.bits, code.length); }
  void flush() {
    std::memcpy(at_ + size_, &bits_, sizeof bits_);
    size_ += static_cast<std::size_t>(held_ >> 3);
    bits_ >>= held_ & ~7;
    held_ &= 7;
  }
  void end() {
    held_ = (held_ + 7) & ~7;
    flush();
    out_.resize(size_);
  }

 private:
  std::vector<std::byte>& out_;
  std::byte* at_ = nullptr;
  std::size_t size_ = 0;
  std::uint64_t bits_ = 0;
  int held_ = 0;
};

std::uint64_t group_at(const std::byte* at) {
  std::uint64_t bytes = 0;
  std::memcpy(&bytes, at, group);
  return bytes;
}

// Calls literals(first, count) and run(length), of the byte before it, in their order.
template <class Literals, class Run>
void read(std::span<const std::byte> all, std::size_t begin, std::size_t end, Literals&& literals,
          Run&& run) {
  const std::byte* bytes = all.data();
  std::size_t at = begin;
  const auto repeats = [&](std::size_t i) {
    return i > 0 && i + group <= end && group_at(bytes + i) == group_at(bytes + i - 1);
  };
  while (at < end) {
    std::size_t length = 0;
    while (length < longest_run && repeats(at + length)) length += group;
    if (length > 0) {
      run(length);
      at += length;
    } else {
      const std::size_t count = std::min(group, end - at);
      literals(bytes + at, count);
      at += count;
    }
  }
}

void put_block(std::span<const std::byte> all, std::size_t begin, std::size_t end, BitWriter& out) {
  std::array<std::array<std::uint32_t, 256>, 4> bytes{};  // four, since a byte often follows itself
  std::array<std::uint32_t, symbols> counts{};
  read(
      all, begin, end,
      [&](const std::byte* first, std::size_t count) {
        for (std::size_t i = 0; i < count; ++i) ++bytes[i % 4][std::to_integer<std::size_t>(first[i])];
      },
      [&](std::size_t length) { ++counts[static_cast<std::size_t>(run_length(length).symbol)]; });
  for (const auto& some : bytes)
    for (std::size_t i = 0; i < 256; ++i) counts[i] += some[i];
  counts[end_of_block] = 1;
  const auto lengths = code_lengths(counts, longest_code);
  const auto codes = codes_of(lengths);

  // The codes' lengths, each by a code of its own; one distance, of one byte.
  std::array<std::uint32_t, 19> length_counts{};
  for (const std::uint8_t length : lengths) ++length_counts[length];
  ++length_counts[1];
  const auto length_lengths = code_lengths(length_counts, longest_length_code);
  const auto length_codes = codes_of(length_lengths);
  constexpr std::array<std::uint8_t, 19> order{16, 17, 18, 0, 8,  7, 9,  6, 10, 5,
                                               11, 4,  12, 3, 13, 2, 14, 1, 15};
  out.reserve(1024 + 2 * (end - begin));
  out.put(end == all.size() ? 1 : 0, 1);
  out.put(2, 2);
  out.put(symbols - 257, 5);
  out.put(0, 5);
  out.put(order.size() - 4, 4);
  for (const std::uint8_t symbol : order) {
    out.flush();
    out.put(length_lengths[symbol], 3);
  }
  for (const std::uint8_t length : lengths) {
    out.flush();
    out.put(length_codes[length]);
  }
  out.put(length_codes[1]);
  out.flush();

  read(
      all, begin, end,
      [&](const std::byte* first, std::size_t count) {
        for (std::size_t i = 0; i < count; ++i) {
          out.put(codes[std::to_integer<std::size_t>(first[i])]);
          if (i % 3 == 2) out.flush();
        }
        out.flush();
      },
      [&](std::size_t length) {
        const RunLength coded = run_length(length);
        out.put(codes[static_cast<std::size_t>(coded.symbol)]);
        out.put(coded.extra, coded.extra_bits);
        out.put(0, 1);  // the distance
        out.flush();
      });
  out.put(codes[end_of_block]);
  out.flush();
}

}  // namespace

std::vector<std::byte> quickly_deflated(std::span<const std::byte> bytes) {
  std::vector<std::byte> stream;
  BitWriter out(stream);
  out.reserve(2);
  out.put(0x0178, 16);
  out.flush();
  std::size_t begin = 0;
  do {
    const std::size_t end = std::min(bytes.size(), begin + block_bytes);
    put_block(bytes, begin, end, out);
    begin = end;
  } while (begin < bytes.size());
  out.end();
  uLong sum = adler32(0, nullptr, 0);
  sum = adler32_z(sum, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
  for (int shift = 24; shift >= 0; shift -= 8) stream.push_back(static_cast<std::byte>(sum >> shift));
  return stream;
}

}  // namespace fude
