// A picture in shades of grey.
#pragma once

#include <cstdint>
#include <vector>

namespace fude {

struct GreyImage {
  std::int32_t width = 0;
  std::int32_t height = 0;
  std::vector<std::uint8_t> pixels;  // row by row from the top, width × height of them; 0 black
};

}  // namespace fude
