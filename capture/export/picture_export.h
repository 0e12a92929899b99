// A camera's recorded pictures as files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

#include "capture/streams.h"
#include "signal/result.h"

namespace fude {

struct PicturesWritten {
  std::uint64_t written = 0;
  std::uint64_t absent = 0;   // frames whose bytes the session has not
  std::uint64_t damaged = 0;  // raw pictures that are not as large as their frame says
};

// One file a picture in `folder`, which is made: SECONDS_SEQUENCE.jpg of motion JPEG and .png of all else,
// the host's seconds with nine decimals and as many digits as the longest has, so that names sort by time.
// JPEG and PNG are copied; grey and yuyv that were kept as sent become the PNG that gives back their very
// bytes (capture/picture/picture_png.h). `progress` is told the share done. Nothing is written where a file
// is there already, unless `overwrite`. Errors: usage where the stream holds no pictures; not_found where it
// has none; exists; no_access; storage.
Result<PicturesWritten> write_pictures(const Session& session, const SessionStream& stream,
                                       const std::filesystem::path& folder, bool overwrite,
                                       const std::function<void(double)>& progress);

}  // namespace fude
