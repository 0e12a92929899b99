// What is packed quickly, zlib unpacks to the same bytes.
#include "capture/picture/quick_deflate.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <random>

namespace fude {
namespace {

using Bytes = std::vector<std::byte>;

Bytes made(std::size_t count, const std::function<unsigned(std::size_t)>& value) {
  Bytes bytes(count);
  for (std::size_t i = 0; i < count; ++i) bytes[i] = static_cast<std::byte>(value(i));
  return bytes;
}

Bytes inflated(const Bytes& stream, std::size_t size) {
  Bytes bytes(size + 1);
  uLongf length = bytes.size();
  EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(bytes.data()), &length,
                       reinterpret_cast<const Bytef*>(stream.data()), stream.size()),
            Z_OK);
  bytes.resize(length);
  return bytes;
}

void comes_back(const Bytes& bytes) {
  const Bytes stream = quickly_deflated(bytes);
  ASSERT_TRUE(inflated(stream, bytes.size()) == bytes) << bytes.size();
  EXPECT_TRUE(quickly_deflated(bytes) == stream);
}

TEST(QuickDeflate, EveryByteComesBack) {
  std::mt19937 random(3);
  const std::function<unsigned(std::size_t)> kinds[] = {
      [&](std::size_t) { return random(); },
      [](std::size_t) { return 0U; },
      [&](std::size_t) { return random() % 50 == 0 ? random() : 9U; },     // runs of all lengths
      [&](std::size_t) { return std::countr_zero(random() | 1U << 31); },  // few bytes often
      [](std::size_t i) { return static_cast<unsigned>(i / 257); },
      [](std::size_t i) { return static_cast<unsigned>(i % 3); },
  };
  for (const auto& kind : kinds) {
    for (std::size_t count = 0; count < 70; ++count) comes_back(made(count, kind));
    for (const std::size_t count :
         {263U, 264U, 265U, 4096U, (1U << 18) - 1, 1U << 18, (1U << 18) + 1, 700000U})
      comes_back(made(count, kind));
  }
}

// Bytes as often as Fibonacci's numbers give Huffman's longest codes, of 24 bits here; deflate allows 15.
TEST(QuickDeflate, NoCodeIsTooLong) {
  Bytes bytes;
  for (std::size_t byte = 0, often = 1, next = 1; byte < 25; ++byte, next += often, std::swap(often, next))
    bytes.insert(bytes.end(), often, static_cast<std::byte>(byte));
  std::mt19937 random(4);
  std::shuffle(bytes.begin(), bytes.end(), random);
  comes_back(bytes);
  std::reverse(bytes.begin(), bytes.end());
  comes_back(bytes);
}

// The entropy of the bytes is what codes of whole bits nearly reach; runs go below it.
TEST(QuickDeflate, IsNotMuchLargerThanItMustBe) {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, 4);
  const Bytes bytes =
      made(1'000'000, [&](std::size_t) { return static_cast<unsigned>(std::lround(noise(random))); });
  const double entropy_bits = std::log2(4 * std::sqrt(2 * std::numbers::pi * std::numbers::e));
  const double bits =
      8.0 * static_cast<double>(quickly_deflated(bytes).size()) / static_cast<double>(bytes.size());
  std::printf("figure: noise of 4 counts packed to %.3f bits a byte; its entropy is %.3f\n", bits,
              entropy_bits);
  EXPECT_LT(bits, 1.02 * entropy_bits);
  EXPECT_LT(quickly_deflated(Bytes(1'000'000)).size(), 6000U);
}

}  // namespace
}  // namespace fude
