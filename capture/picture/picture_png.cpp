#include "capture/picture/picture_png.h"

#include <png.h>
#include <zlib.h>

#include <algorithm>
#include <csetjmp>
#include <cstring>
#include <string_view>

#include "capture/picture/quick_deflate.h"

namespace fude {
namespace {

constexpr std::byte filter_up{2};
constexpr std::size_t longest_piece = 1 << 20;  // of the packed picture in one chunk
constexpr png_uint_32 largest_side = 65535;

void give_up(png_structp png, png_const_charp) { png_longjmp(png, 1); }
void pass_over(png_structp, png_const_charp) {}

void take(png_structp png, png_bytep bytes, png_size_t count) {
  auto& in = *static_cast<std::span<const std::byte>*>(png_get_io_ptr(png));
  if (count > in.size()) png_error(png, "cut short");
  std::memcpy(bytes, in.data(), count);
  in = in.subspan(count);
}

struct Layout {
  int colour = 0;
  std::size_t channels = 0;
};

void append_number(std::vector<std::byte>& out, std::uint32_t number) {
  for (int shift = 24; shift >= 0; shift -= 8) out.push_back(static_cast<std::byte>(number >> shift));
}

void append_chunk(std::vector<std::byte>& out, std::string_view kind, std::span<const std::byte> content) {
  append_number(out, static_cast<std::uint32_t>(content.size()));
  const std::size_t begin = out.size();
  const auto* name = reinterpret_cast<const std::byte*>(kind.data());
  out.insert(out.end(), name, name + kind.size());
  out.insert(out.end(), content.begin(), content.end());
  const auto* checked = reinterpret_cast<const Bytef*>(out.data() + begin);
  append_number(out, static_cast<std::uint32_t>(crc32_z(0, checked, out.size() - begin)));
}

// Each row less the one above it, which also suits the alternating U and V of a yuyv row, whose left
// neighbour is of the other kind.
std::vector<std::byte> filtered(std::span<const std::byte> pixels, std::size_t row, std::size_t rows) {
  std::vector<std::byte> out((1 + row) * rows);
  for (std::size_t y = 0; y < rows; ++y) {
    std::byte* to = out.data() + y * (1 + row);
    const std::byte* from = pixels.data() + y * row;
    *to++ = filter_up;
    if (y == 0) std::memcpy(to, from, row);
    for (std::size_t x = 0; y > 0 && x < row; ++x)
      to[x] = static_cast<std::byte>(std::to_integer<unsigned>(from[x]) -
                                     std::to_integer<unsigned>((from - row)[x]));
  }
  return out;
}

// PNG specification, third edition, 5. Pictures come thirty times a second, and libpng packs them by zlib
// alone.
std::vector<std::byte> encode(std::span<const std::byte> pixels, Layout layout, png_uint_32 width,
                              png_uint_32 height) {
  const std::vector<std::byte> packed = quickly_deflated(filtered(pixels, width * layout.channels, height));
  std::vector<std::byte> head;
  append_number(head, width);
  append_number(head, height);
  for (const int field :
       {8, layout.colour, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT, PNG_INTERLACE_NONE})
    head.push_back(static_cast<std::byte>(field));
  std::vector<std::byte> out;
  out.reserve(packed.size() + 100 + packed.size() / longest_piece * 12);
  for (const int c : {0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a})
    out.push_back(static_cast<std::byte>(c));
  append_chunk(out, "IHDR", head);
  for (std::span<const std::byte> rest = packed; !rest.empty();
       rest = rest.subspan(std::min(rest.size(), longest_piece)))
    append_chunk(out, "IDAT", rest.first(std::min(rest.size(), longest_piece)));
  append_chunk(out, "IEND", {});
  return out;
}

Result<std::vector<std::byte>> to_png(std::span<const std::byte> pixels, Layout layout, std::int32_t width,
                                      std::int32_t height) {
  const auto columns = static_cast<png_uint_32>(std::max(width, 0));
  const auto rows = static_cast<png_uint_32>(std::max(height, 0));
  if (columns < 1 || rows < 1 || columns > largest_side || rows > largest_side ||
      pixels.size() != std::size_t{columns} * rows * layout.channels)
    return failure(Fault::malformed, "a picture of " + std::to_string(width) + " x " +
                                         std::to_string(height) + " has not " +
                                         std::to_string(pixels.size()) + " bytes");
  return encode(pixels, layout, columns, rows);
}

enum class Reading { done, damaged, foreign };

Reading decode(std::span<const std::byte>& in, RawPicture& picture) {
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, give_up, pass_over);
  png_infop head = png ? png_create_info_struct(png) : nullptr;
  if (!head || setjmp(png_jmpbuf(png))) {
    png_destroy_read_struct(&png, &head, nullptr);
    return Reading::damaged;
  }
  png_set_user_limits(png, largest_side, largest_side);
  png_set_crc_action(png, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
  png_set_read_fn(png, &in, take);
  png_read_info(png, head);
  const png_uint_32 width = png_get_image_width(png, head);
  const png_uint_32 height = png_get_image_height(png, head);
  const int colour = png_get_color_type(png, head);
  const bool ours = (colour == PNG_COLOR_TYPE_GRAY || colour == PNG_COLOR_TYPE_GRAY_ALPHA) &&
                    png_get_bit_depth(png, head) == 8 &&
                    png_get_interlace_type(png, head) == PNG_INTERLACE_NONE;
  if (!ours) {
    png_destroy_read_struct(&png, &head, nullptr);
    return Reading::foreign;
  }
  picture.format = colour == PNG_COLOR_TYPE_GRAY ? PixelFormat::grey : PixelFormat::yuyv;
  picture.width = static_cast<std::int32_t>(width);
  picture.height = static_cast<std::int32_t>(height);
  const std::size_t row = png_get_rowbytes(png, head);
  // A head may promise what the file cannot hold: memory grows with what has come.
  for (png_uint_32 y = 0; y < height; ++y) {
    picture.bytes.resize(picture.bytes.size() + row);
    png_read_row(png, reinterpret_cast<png_bytep>(picture.bytes.data() + y * row), nullptr);
  }
  png_read_end(png, nullptr);
  png_destroy_read_struct(&png, &head, nullptr);
  return Reading::done;
}

}  // namespace

Result<std::vector<std::byte>> raw_to_png(std::span<const std::byte> picture, PixelFormat format,
                                          std::int32_t width, std::int32_t height) {
  switch (format) {
    case PixelFormat::grey:
      return to_png(picture, {PNG_COLOR_TYPE_GRAY, 1}, width, height);
    case PixelFormat::yuyv:
      return to_png(picture, {PNG_COLOR_TYPE_GRAY_ALPHA, 2}, width, height);
    default:
      return failure(Fault::unsupported, "only GREY and YUYV pictures are kept byte by byte in a PNG");
  }
}

Result<std::vector<std::byte>> rgb_to_png(std::span<const std::byte> pixels, std::int32_t width,
                                          std::int32_t height) {
  return to_png(pixels, {PNG_COLOR_TYPE_RGB, 3}, width, height);
}

Result<RawPicture> raw_from_png(std::span<const std::byte> png) {
  RawPicture picture;
  switch (decode(png, picture)) {
    case Reading::done:
      return picture;
    case Reading::foreign:
      return failure(Fault::unsupported, "this PNG holds no camera's bytes, but a picture's colours");
    case Reading::damaged:
      break;
  }
  return failure(Fault::malformed, "this is no PNG, or a damaged one");
}

}  // namespace fude
