// A finished picture: 16-bit sRGB, one pixel a cell of the paper.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace fude {

using Rgb16 = std::array<std::uint16_t, 3>;

// Row-major, the top row (the paper's far edge, the greatest y) first.
struct Picture {
  int width = 0;
  int height = 0;
  std::vector<Rgb16> pixels;

  Picture() = default;
  Picture(int columns, int rows)
      : width(columns),
        height(rows),
        pixels(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows)) {}

  std::span<Rgb16> row(int y) { return {pixels.data() + start(y), static_cast<std::size_t>(width)}; }
  std::span<const Rgb16> row(int y) const {
    return {pixels.data() + start(y), static_cast<std::size_t>(width)};
  }

 private:
  std::size_t start(int y) const { return static_cast<std::size_t>(y) * static_cast<std::size_t>(width); }
};

// SHA-256 of the pixels, row-major, red green blue, high byte first as in a PNG: 64 hex digits.
std::string picture_sha256(const Picture& picture);

}  // namespace fude
