#include "sim/optics/png_file.h"

#include <fcntl.h>
#include <png.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csetjmp>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace fude {
namespace {

// Fast, and within a few per cent of the slower levels on washes and blank paper.
constexpr int compression_level = 3;

tl::unexpected<Error> refused(int error_number, const std::filesystem::path& path) {
  const std::string place = "cannot write " + path.string() + ": ";
  switch (error_number) {
    case ENOSPC:
    case EDQUOT:
      return failure(Fault::storage, place + "the disk is full; free some space or choose another folder");
    case ENOENT:
    case ENOTDIR:
      return failure(Fault::not_found, place + "there is no such folder; make it first");
    case EACCES:
    case EPERM:
      return failure(Fault::no_access, place + "permission denied; choose a folder you may write in");
    case EROFS:
      return failure(Fault::no_access, place + "the disk is read-only; choose another folder");
    case EEXIST:
      return failure(Fault::exists, place + "it exists already; choose another name or add --force");
    default:
      return failure(Fault::storage, place + std::strerror(error_number));
  }
}

// The unfinished file beside its place; removed unless it was moved there.
class PartFile {
 public:
  explicit PartFile(const std::filesystem::path& target)
      : name_((target.parent_path() / ("." + target.filename().string() + ".XXXXXX")).string()),
        descriptor_(mkostemp(name_.data(), O_CLOEXEC)) {}
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;
  ~PartFile() {
    if (descriptor_ < 0) return;
    close(descriptor_);
    if (!moved_) unlink(name_.c_str());
  }

  int descriptor() const { return descriptor_; }

  // 0, or the error's number.
  int move_to(const std::filesystem::path& target, bool overwrite) {
    const mode_t mask = umask(0);
    umask(mask);
    if (fchmod(descriptor_, 0666 & ~mask) != 0 || fsync(descriptor_) != 0) return errno;
    int status =
        renameat2(AT_FDCWD, name_.c_str(), AT_FDCWD, target.c_str(), overwrite ? 0 : RENAME_NOREPLACE);
    if (status != 0 && errno == EINVAL)
      status = std::rename(name_.c_str(), target.c_str());  // no such flag there
    if (status != 0) return errno;
    moved_ = true;
    return 0;
  }

 private:
  std::string name_;
  int descriptor_;
  bool moved_ = false;
};

// Where libpng's bytes go. A failed write is kept for the end: libpng itself need not stop.
struct Sink {
  int descriptor;
  int error_number = 0;
};

void write_bytes(png_structp png, png_bytep bytes, png_size_t count) {
  Sink& sink = *static_cast<Sink*>(png_get_io_ptr(png));
  while (count > 0 && sink.error_number == 0) {
    const ssize_t written = write(sink.descriptor, bytes, count);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      sink.error_number = errno;
      return;
    }
    bytes += written;
    count -= static_cast<std::size_t>(written);
  }
}

void pack_row(std::span<const Rgb16> pixels, int depth, std::uint8_t* bytes) {
  for (const Rgb16& pixel : pixels)
    for (const std::uint16_t value : pixel) {
      if (depth == 8) {
        *bytes++ = static_cast<std::uint8_t>((value + 128) / 257);
        continue;
      }
      *bytes++ = static_cast<std::uint8_t>(value >> 8);
      *bytes++ = static_cast<std::uint8_t>(value & 0xff);
    }
}

// False when libpng gave up (out of memory). Its longjmp passes no destructor: rows come from outside.
bool encode(Sink& sink, const Picture& picture, int depth, std::uint8_t* row_bytes) {
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop header = png ? png_create_info_struct(png) : nullptr;
  if (!header || setjmp(png_jmpbuf(png))) {
    png_destroy_write_struct(&png, &header);
    return false;
  }
  png_set_write_fn(png, &sink, write_bytes, nullptr);
  png_set_compression_level(png, compression_level);
  png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB | PNG_FILTER_UP);
  png_set_IHDR(png, header, static_cast<png_uint_32>(picture.width), static_cast<png_uint_32>(picture.height),
               depth, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB_gAMA_and_cHRM(png, header, PNG_sRGB_INTENT_PERCEPTUAL);
  png_write_info(png, header);
  for (int y = 0; y < picture.height && sink.error_number == 0; ++y) {
    pack_row(picture.row(y), depth, row_bytes);
    png_write_row(png, row_bytes);
  }
  if (sink.error_number == 0) png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &header);
  return true;
}

}  // namespace

Result<void> write_png(const std::filesystem::path& path, const Picture& picture, const PngOptions& options) {
  constexpr int most_pixels = 1'000'000;
  if (options.depth != 8 && options.depth != 16)
    return failure(Fault::usage,
                   "a PNG here has 8 or 16 bits a channel, not " + std::to_string(options.depth));
  if (picture.width < 1 || picture.height < 1) return failure(Fault::usage, "the picture has no pixels");
  if (picture.width > most_pixels || picture.height > most_pixels)
    return failure(Fault::usage,
                   "a PNG has at most a million pixels a side: choose larger cells or a smaller sheet");
  if (struct stat existing; lstat(path.c_str(), &existing) == 0) {
    if (!options.overwrite) return refused(EEXIST, path);
    // Moving a picture onto a device node would replace the node.
    if (!S_ISREG(existing.st_mode))
      return failure(Fault::no_access, path.string() + " is no file; give the name of a picture (.png)");
  }

  PartFile part(path);
  if (part.descriptor() < 0) return refused(errno, path);
  Sink sink{part.descriptor()};
  std::vector<std::uint8_t> row_bytes(static_cast<std::size_t>(picture.width) * 6);
  const bool encoded = encode(sink, picture, options.depth, row_bytes.data());
  if (sink.error_number != 0) return refused(sink.error_number, path);
  if (!encoded) return refused(ENOMEM, path);
  if (const int error_number = part.move_to(path, options.overwrite); error_number != 0)
    return refused(error_number, path);
  return {};
}

}  // namespace fude
