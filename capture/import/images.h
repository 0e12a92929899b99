// Pictures as a camera's frames: a folder, a pattern (frame_*.png) or a single file.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "capture/import/recording.h"
#include "signal/result.h"

namespace fude {

inline constexpr double default_picture_rate_hz = 1;

struct PictureHead {
  PixelFormat format = PixelFormat::png;  // or mjpeg, for a JPEG
  std::int32_t width = 0;
  std::int32_t height = 0;
};

// By the first bytes; none for anything but PNG and JPEG, and where no size of 1 to 65535 pixels stands in
// them.
std::optional<PictureHead> picture_head(std::span<const std::byte> bytes);

// Whether a path is a folder or a pattern of one, so that it names several files.
bool names_several(const std::filesystem::path& path);

// The files in the order of their names, numbers in them by value.
std::vector<std::filesystem::path> files_of(const std::filesystem::path& path);

// One frame a file, 1/`rate_hz` apart from 0; their bytes are kept as `picture` transfers. Files that are no
// PNG or JPEG are passed over and counted. Errors: not_found where there is no picture, unsupported beyond 1
// GiB in all, usage for a rate that is not between 0.001 and 1,000,000.
Result<RawRecording> import_images(const std::filesystem::path& path, double rate_hz);

}  // namespace fude
