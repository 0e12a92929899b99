// A page of black rectangles at true scale, as a PDF or a PNG.
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "signal/result.h"

namespace fude {

// Millimetres from the upper left corner of the page, x to the right and y down.
struct PrintedArea {
  Eigen::Vector2d corner_mm;
  Eigen::Vector2d size_mm;
};

struct PrintedPage {
  Eigen::Vector2d size_mm;
  std::vector<PrintedArea> black;
};

// Upper-case letters, digits, '.', '-' and '_' as rectangles; `height_mm` of a letter, the line's upper left
// corner at `corner_mm`. What has no letter here is a space.
std::vector<PrintedArea> lettering(std::string_view text, const Eigen::Vector2d& corner_mm, double height_mm);

// PDF 1.4: the page filled with what is black, in millimetres.
std::string pdf_of(const PrintedPage& page);

// One bit a pixel, 20 pixels a millimetre, which its pHYs chunk states. Errors: storage.
Result<std::string> png_of(const PrintedPage& page);
inline constexpr int png_pixels_per_mm = 20;

}  // namespace fude
