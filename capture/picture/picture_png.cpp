#include "capture/picture/picture_png.h"

#include <png.h>
#include <zlib.h>

#include <algorithm>
#include <csetjmp>
#include <cstring>

namespace fude {
namespace {

// Pictures come thirty times a second, and a sensor's noise repeats nothing: of earlier bytes only runs of
// one are looked for (zlib's Z_RLE, made for PNG), which beside noise is faster than looking further, and no
// larger. One filter, which also suits the alternating U and V of a yuyv row, whose left neighbour is of the
// other kind.
constexpr int compression_level = 1;
constexpr int filter = PNG_FILTER_UP;
constexpr png_size_t piece_bytes = 1 << 18;  // of the packed picture, each with a head and a checksum
constexpr png_uint_32 largest_side = 65535;

void give_up(png_structp png, png_const_charp) { png_longjmp(png, 1); }
void pass_over(png_structp, png_const_charp) {}

void append(png_structp png, png_bytep bytes, png_size_t count) {
  auto& out = *static_cast<std::vector<std::byte>*>(png_get_io_ptr(png));
  const auto* begin = reinterpret_cast<const std::byte*>(bytes);
  out.insert(out.end(), begin, begin + count);
}

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

// False when libpng gave up. Its longjmp passes no destructor: the vector comes from outside.
bool encode(std::span<const std::byte> pixels, Layout layout, png_uint_32 width, png_uint_32 height,
            std::vector<std::byte>& out) {
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, give_up, pass_over);
  png_infop head = png ? png_create_info_struct(png) : nullptr;
  if (!head || setjmp(png_jmpbuf(png))) {
    png_destroy_write_struct(&png, &head);
    return false;
  }
  png_set_write_fn(png, &out, append, nullptr);
  png_set_compression_level(png, compression_level);
  png_set_compression_strategy(png, Z_RLE);
  png_set_compression_buffer_size(png, piece_bytes);
  png_set_filter(png, PNG_FILTER_TYPE_BASE, filter);
  png_set_IHDR(png, head, width, height, 8, layout.colour, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, head);
  for (png_uint_32 y = 0; y < height; ++y)
    png_write_row(png, reinterpret_cast<png_const_bytep>(pixels.data() + y * width * layout.channels));
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &head);
  return true;
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
  std::vector<std::byte> out;
  out.reserve(pixels.size());
  if (!encode(pixels, layout, columns, rows, out))
    return failure(Fault::storage, "no memory for a picture's PNG; record smaller pictures");
  return out;
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
