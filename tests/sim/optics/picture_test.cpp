#include "sim/optics/picture.h"

#include <gtest/gtest.h>

namespace fude {
namespace {

// Text whose length is a multiple of six, as the pixels that spell it.
Picture spelling(const std::string& text, int width, int height) {
  Picture picture(width, height);
  std::size_t at = 0;
  for (Rgb16& pixel : picture.pixels)
    for (std::uint16_t& value : pixel) {
      value = static_cast<std::uint16_t>((static_cast<unsigned char>(text[at]) << 8) |
                                         static_cast<unsigned char>(text[at + 1]));
      at += 2;
    }
  return picture;
}

TEST(PictureSha256, OfNoPixelsIsThatOfNoBytes) {
  // FIPS 180-4's empty message.
  EXPECT_EQ(picture_sha256(Picture()), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

TEST(PictureSha256, ReadsPixelsInOrderHighByteFirst) {
  // From coreutils: printf 'abcdefghijkl' | sha256sum
  const char* want = "d682ed4ca4d989c134ec94f1551e1ec580dd6d5a6ecde9f3d35e6e4a717fbde4";
  EXPECT_EQ(picture_sha256(spelling("abcdefghijkl", 2, 1)), want);
  EXPECT_EQ(picture_sha256(spelling("abcdefghijkl", 1, 2)), want);
}

TEST(PictureSha256, SpansManyBlocks) {
  // FIPS 180-4's million times 'a' is no multiple of six; from coreutils: head -c 999996 | tr '\0' a.
  EXPECT_EQ(picture_sha256(spelling(std::string(999996, 'a'), 166666, 1)),
            "86ff3ae5c0b59ff1b6f713838a1205c3bd4532c4556ef0ebb19d56759f911e2c");
}

}  // namespace
}  // namespace fude
