#include "capture/import/images.h"

#include <glob.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fstream>
#include <utility>

#include "capture/import/gzip.h"

namespace fude {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t largest_in_all = std::size_t{1} << 30;

std::uint32_t big_endian(std::span<const std::byte> bytes, std::size_t at, std::size_t length) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < length; ++i) value = value << 8 | std::to_integer<std::uint32_t>(bytes[at + i]);
  return value;
}

bool begins_with(std::span<const std::byte> bytes, std::initializer_list<unsigned> head) {
  return bytes.size() >= head.size() &&
         std::equal(head.begin(), head.end(), bytes.begin(),
                    [](unsigned a, std::byte b) { return a == std::to_integer<unsigned>(b); });
}

std::optional<PictureHead> sized(PixelFormat format, std::uint32_t width, std::uint32_t height) {
  if (width < 1 || width > 65535 || height < 1 || height > 65535) return std::nullopt;
  return PictureHead{format, static_cast<std::int32_t>(width), static_cast<std::int32_t>(height)};
}

// The first start-of-frame segment holds the size (ITU T.81 B.2.2).
std::optional<PictureHead> jpeg_head(std::span<const std::byte> bytes) {
  std::size_t at = 2;
  while (at + 9 <= bytes.size()) {
    if (bytes[at] != std::byte{0xff}) return std::nullopt;
    const auto marker = std::to_integer<unsigned>(bytes[at + 1]);
    if (marker == 0xff) {  // filling
      ++at;
      continue;
    }
    const bool frame = marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
    if (frame) return sized(PixelFormat::mjpeg, big_endian(bytes, at + 7, 2), big_endian(bytes, at + 5, 2));
    at += 2 + big_endian(bytes, at + 2, 2);
  }
  return std::nullopt;
}

// left2 before left10.
bool before(const fs::path& a, const fs::path& b) {
  const std::string x = a.native(), y = b.native();
  std::size_t i = 0, j = 0;
  const auto digit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; };
  while (i < x.size() && j < y.size()) {
    if (digit(x[i]) && digit(y[j])) {
      const auto number = [&](const std::string& s, std::size_t& at) {
        while (at < s.size() && s[at] == '0') ++at;
        const std::size_t begin = at;
        while (at < s.size() && digit(s[at])) ++at;
        return std::pair(at - begin, s.substr(begin, at - begin));
      };
      const auto m = number(x, i), n = number(y, j);
      if (m != n) return m < n;
    } else {
      if (x[i] != y[j]) return x[i] < y[j];
      ++i;
      ++j;
    }
  }
  return std::pair(x.size() - i, x) < std::pair(y.size() - j, y);
}

Result<std::vector<std::byte>> read_picture(const fs::path& file) {
  std::error_code status;
  const auto size = fs::file_size(file, status);
  if (!status && size > largest_import)
    return failure(Fault::unsupported, file.string() + " is larger than 256 MiB; give smaller pictures");
  std::ifstream stream(file, std::ios::binary);
  if (status || !stream)
    return failure(Fault::no_access, "no permission to read " + file.string() + "; try `chmod +r` on it");
  std::vector<std::byte> bytes(size);
  stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  bytes.resize(static_cast<std::size_t>(stream.gcount()));
  return bytes;
}

}  // namespace

std::optional<PictureHead> picture_head(std::span<const std::byte> bytes) {
  if (begins_with(bytes, {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'}) && bytes.size() >= 24)
    return sized(PixelFormat::png, big_endian(bytes, 16, 4), big_endian(bytes, 20, 4));
  if (begins_with(bytes, {0xff, 0xd8, 0xff})) return jpeg_head(bytes);
  return std::nullopt;
}

bool names_several(const fs::path& path) {
  std::error_code status;
  if (fs::is_directory(path, status)) return true;
  return !fs::exists(path, status) && path.native().find_first_of("*?[") != std::string::npos;
}

std::vector<fs::path> files_of(const fs::path& path) {
  std::vector<fs::path> files;
  std::error_code status;
  if (fs::is_directory(path, status)) {
    for (fs::directory_iterator entry(path, status), end; !status && entry != end; entry.increment(status))
      files.push_back(entry->path());
  } else if (fs::exists(path, status)) {
    files.push_back(path);
  } else {
    glob_t found{};
    if (glob(path.c_str(), 0, nullptr, &found) == 0)
      for (std::size_t i = 0; i < found.gl_pathc; ++i) files.emplace_back(found.gl_pathv[i]);
    globfree(&found);
  }
  std::erase_if(files, [&](const fs::path& file) { return !fs::is_regular_file(file, status); });
  std::sort(files.begin(), files.end(), before);
  return files;
}

Result<RawRecording> import_images(const fs::path& path, double rate_hz) {
  if (!(rate_hz >= 0.001 && rate_hz <= 1e6)) return failure(Fault::usage, "--rate-hz takes 0.001 to 1000000");
  RawRecording recording;
  recording.device = DeviceDescription{
      .id = "text:images", .name = "camera", .kind = DeviceKind::camera, .transport = "text"};
  std::size_t in_all = 0;
  for (const fs::path& file : files_of(path)) {
    auto bytes = read_picture(file);
    if (!bytes) return tl::unexpected(bytes.error());
    ++recording.counts.events;
    const auto head = picture_head(*bytes);
    if (!head) {
      ++recording.passed_over["files that are no PNG or JPEG"];
      continue;
    }
    in_all += bytes->size();
    if (in_all > largest_in_all)
      return failure(Fault::unsupported,
                     path.string() + " holds more than 1 GiB of pictures; import them in parts");
    const auto number = recording.samples.size();
    const Timestamp time(Duration(std::llround(static_cast<double>(number) / rate_hz * 1e9)));
    CameraFrame frame{.time = {time, StampedBy::recording, number, std::nullopt}};
    frame.format = head->format;
    frame.width = head->width;
    frame.height = head->height;
    ++recording.counts.frames;
    recording.samples.emplace_back(frame);
    recording.transfers.push_back(
        {time, StampedBy::recording, Direction::from_device, TransferKind::picture, std::move(*bytes)});
  }
  if (recording.samples.empty())
    return failure(Fault::not_found,
                   path.string() + " holds no PNG or JPEG; name a folder, a pattern or a picture");
  return recording;
}

}  // namespace fude
