// A picture as a PNG file, its colours stated as sRGB.
#pragma once

#include <filesystem>

#include "signal/result.h"
#include "sim/optics/picture.h"

namespace fude {

struct PngOptions {
  int depth = 16;          // bits a channel, 8 or 16
  bool overwrite = false;  // whether a file of that name may be replaced
};

// The file appears whole or not at all: it is written beside its place and moved there when it is on
// the disk. At most a million pixels a side (libpng's limit).
// Errors: usage (depth, no pixels, too large), exists, not_found (no
// such folder), no_access, storage (disk full or failing).
Result<void> write_png(const std::filesystem::path& path, const Picture& picture,
                       const PngOptions& options = {});

}  // namespace fude
