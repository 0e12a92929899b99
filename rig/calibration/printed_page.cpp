#include "rig/calibration/printed_page.h"

#include <png.h>

#include <array>
#include <cmath>
#include <csetjmp>
#include <cstdio>
#include <string_view>

namespace fude {
namespace {

constexpr int letter_columns = 5, letter_rows = 7;

// A letter's rows from the top, five bits each, the left one highest.
struct Letter {
  char name;
  std::array<unsigned char, letter_rows> rows;
};
constexpr Letter letters[] = {
    {'0', {0b01110, 0b10001, 0b10001, 0b10001, 0b10001, 0b10001, 0b01110}},
    {'1', {0b00100, 0b01100, 0b00100, 0b00100, 0b00100, 0b00100, 0b01110}},
    {'2', {0b01110, 0b10001, 0b00001, 0b00110, 0b01000, 0b10000, 0b11111}},
    {'3', {0b11110, 0b00001, 0b00001, 0b01110, 0b00001, 0b00001, 0b11110}},
    {'4', {0b00010, 0b00110, 0b01010, 0b10010, 0b11111, 0b00010, 0b00010}},
    {'5', {0b11111, 0b10000, 0b11110, 0b00001, 0b00001, 0b10001, 0b01110}},
    {'6', {0b00110, 0b01000, 0b10000, 0b11110, 0b10001, 0b10001, 0b01110}},
    {'7', {0b11111, 0b00001, 0b00010, 0b00100, 0b00100, 0b01000, 0b01000}},
    {'8', {0b01110, 0b10001, 0b10001, 0b01110, 0b10001, 0b10001, 0b01110}},
    {'9', {0b01110, 0b10001, 0b10001, 0b01111, 0b00001, 0b00010, 0b01100}},
    {'A', {0b00100, 0b01010, 0b10001, 0b10001, 0b11111, 0b10001, 0b10001}},
    {'B', {0b11110, 0b10001, 0b10001, 0b11110, 0b10001, 0b10001, 0b11110}},
    {'C', {0b01110, 0b10001, 0b10000, 0b10000, 0b10000, 0b10001, 0b01110}},
    {'D', {0b11100, 0b10010, 0b10001, 0b10001, 0b10001, 0b10010, 0b11100}},
    {'E', {0b11111, 0b10000, 0b10000, 0b11110, 0b10000, 0b10000, 0b11111}},
    {'F', {0b11111, 0b10000, 0b10000, 0b11110, 0b10000, 0b10000, 0b10000}},
    {'G', {0b01110, 0b10001, 0b10000, 0b10111, 0b10001, 0b10001, 0b01110}},
    {'H', {0b10001, 0b10001, 0b10001, 0b11111, 0b10001, 0b10001, 0b10001}},
    {'I', {0b01110, 0b00100, 0b00100, 0b00100, 0b00100, 0b00100, 0b01110}},
    {'K', {0b10001, 0b10010, 0b10100, 0b11000, 0b10100, 0b10010, 0b10001}},
    {'L', {0b10000, 0b10000, 0b10000, 0b10000, 0b10000, 0b10000, 0b11111}},
    {'M', {0b10001, 0b11011, 0b10101, 0b10101, 0b10001, 0b10001, 0b10001}},
    {'N', {0b10001, 0b11001, 0b10101, 0b10101, 0b10011, 0b10001, 0b10001}},
    {'O', {0b01110, 0b10001, 0b10001, 0b10001, 0b10001, 0b10001, 0b01110}},
    {'P', {0b11110, 0b10001, 0b10001, 0b11110, 0b10000, 0b10000, 0b10000}},
    {'Q', {0b01110, 0b10001, 0b10001, 0b10001, 0b10101, 0b10010, 0b01101}},
    {'R', {0b11110, 0b10001, 0b10001, 0b11110, 0b10100, 0b10010, 0b10001}},
    {'S', {0b01111, 0b10000, 0b10000, 0b01110, 0b00001, 0b00001, 0b11110}},
    {'T', {0b11111, 0b00100, 0b00100, 0b00100, 0b00100, 0b00100, 0b00100}},
    {'U', {0b10001, 0b10001, 0b10001, 0b10001, 0b10001, 0b10001, 0b01110}},
    {'V', {0b10001, 0b10001, 0b10001, 0b10001, 0b01010, 0b01010, 0b00100}},
    {'W', {0b10001, 0b10001, 0b10001, 0b10101, 0b10101, 0b11011, 0b10001}},
    {'X', {0b10001, 0b10001, 0b01010, 0b00100, 0b01010, 0b10001, 0b10001}},
    {'Y', {0b10001, 0b10001, 0b01010, 0b00100, 0b00100, 0b00100, 0b00100}},
    {'.', {0, 0, 0, 0, 0, 0b01100, 0b01100}},
    {'-', {0, 0, 0, 0b11111, 0, 0, 0}},
    {'_', {0, 0, 0, 0, 0, 0, 0b11111}},
};

void add_row(std::vector<PrintedArea>& areas, unsigned bits, const Eigen::Vector2d& corner_mm,
             double dot_mm) {
  const auto black = [bits](int column) { return ((bits >> (letter_columns - 1 - column)) & 1U) != 0; };
  for (int first = 0; first < letter_columns; ++first) {
    int end = first;
    while (end < letter_columns && black(end)) ++end;
    if (end > first)
      areas.push_back({corner_mm + Eigen::Vector2d(first * dot_mm, 0), {(end - first) * dot_mm, dot_mm}});
    first = end;
  }
}

// One bit a pixel, 1 is white.
class Bitmap {
 public:
  explicit Bitmap(const Eigen::Vector2d& size_mm)
      : width_(pixels(size_mm.x())),
        height_(pixels(size_mm.y())),
        stride_((std::size_t(width_) + 7) / 8),
        bits_(stride_ * std::size_t(height_), 0xff) {}

  static int pixels(double mm) { return static_cast<int>(std::lround(mm * png_pixels_per_mm)); }

  void blacken(const PrintedArea& area) {
    const Eigen::Vector2d end = area.corner_mm + area.size_mm;
    for (int y = pixels(area.corner_mm.y()); y < pixels(end.y()); ++y)
      for (int x = pixels(area.corner_mm.x()); x < pixels(end.x()); ++x)
        bits_[std::size_t(y) * stride_ + std::size_t(x) / 8] &=
            static_cast<unsigned char>(~(0x80U >> (unsigned(x) % 8)));
  }

  int width() const { return width_; }
  int height() const { return height_; }
  unsigned char* row(int y) { return bits_.data() + std::size_t(y) * stride_; }

 private:
  int width_, height_;
  std::size_t stride_;
  std::vector<unsigned char> bits_;
};

void append(png_structp png, png_bytep bytes, png_size_t count) {
  static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<const char*>(bytes), count);
}

void number(std::string& text, double value) {
  char digits[32];
  std::snprintf(digits, sizeof digits, "%.4f ", value);
  text += digits;
}

}  // namespace

std::vector<PrintedArea> lettering(std::string_view text, const Eigen::Vector2d& corner_mm,
                                   double height_mm) {
  const double dot_mm = height_mm / letter_rows;
  std::vector<PrintedArea> areas;
  for (std::size_t i = 0; i < text.size(); ++i)
    for (const Letter& letter : letters)
      for (std::size_t row = 0; letter.name == text[i] && row < letter_rows; ++row)
        add_row(areas, letter.rows[row],
                corner_mm + dot_mm * Eigen::Vector2d(double(i) * (letter_columns + 1), double(row)), dot_mm);
  return areas;
}

std::string pdf_of(const PrintedPage& page) {
  constexpr double points_per_mm = 72 / 25.4;
  std::string content;
  number(content, points_per_mm);
  content += "0 0 ";
  number(content, -points_per_mm);
  content += "0 ";
  number(content, page.size_mm.y() * points_per_mm);
  content += "cm 0 g\n";
  for (const PrintedArea& area : page.black) {
    for (const double v : {area.corner_mm.x(), area.corner_mm.y(), area.size_mm.x(), area.size_mm.y()})
      number(content, v);
    content += "re\n";
  }
  content += "f\n";
  std::string box = "[0 0 ";
  number(box, page.size_mm.x() * points_per_mm);
  number(box, page.size_mm.y() * points_per_mm);
  const std::string objects[] = {
      "<< /Type /Catalog /Pages 2 0 R /ViewerPreferences << /PrintScaling /None >> >>",
      "<< /Type /Pages /Kids [3 0 R] /Count 1 >>",
      "<< /Type /Page /Parent 2 0 R /MediaBox " + box + "] /Resources << >> /Contents 4 0 R >>",
      "<< /Length " + std::to_string(content.size()) + " >>\nstream\n" + content + "endstream"};
  std::string pdf = "%PDF-1.4\n", places;
  int count = 0;
  for (const std::string& object : objects) {
    char place[24];
    std::snprintf(place, sizeof place, "%010zu 00000 n \n", pdf.size());
    places += place;
    pdf += std::to_string(++count) + " 0 obj\n" + object + "\nendobj\n";
  }
  const std::size_t table = pdf.size();
  const std::string rows = std::to_string(count + 1);
  pdf += "xref\n0 " + rows + "\n0000000000 65535 f \n" + places + "trailer\n<< /Size " + rows +
         " /Root 1 0 R >>\nstartxref\n" + std::to_string(table) + "\n%%EOF\n";
  return pdf;
}

Result<std::string> png_of(const PrintedPage& page) {
  Bitmap bitmap(page.size_mm);
  for (const PrintedArea& area : page.black) bitmap.blacken(area);
  std::string bytes;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
  if (info == nullptr || setjmp(png_jmpbuf(png)) != 0) {
    png_destroy_write_struct(&png, &info);
    return failure(Fault::storage, "the picture of the board could not be made: no memory");
  }
  png_set_write_fn(png, &bytes, append, nullptr);
  png_set_IHDR(png, info, static_cast<png_uint_32>(bitmap.width()), static_cast<png_uint_32>(bitmap.height()),
               1, PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  constexpr png_uint_32 per_metre = 1000 * png_pixels_per_mm;
  png_set_pHYs(png, info, per_metre, per_metre, PNG_RESOLUTION_METER);
  png_write_info(png, info);
  for (int y = 0; y < bitmap.height(); ++y) png_write_row(png, bitmap.row(y));
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return bytes;
}

}  // namespace fude
