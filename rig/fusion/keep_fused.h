// The fused poses, kept beside all that they were made of.
#pragma once

#include <filesystem>
#include <string_view>

#include "capture/session.h"
#include "rig/fusion/fused_table.h"

namespace fude {

// Of the device that stands for the fusion, whose tools are "fused" and "smoothed".
inline constexpr std::string_view fused_device_id = "fude:fused:";

struct FusedArchive {
  const FusedSession& causal;
  const FusedSession& smoothed;
};

// A new session file: the whole of `session`, and both poses as streams with their covariances. An earlier
// fusion that it held is replaced. `overwrite` replaces a file, once the new one is whole.
// Errors: exists, the writer's.
Result<void> keep_fused(Session session, const FusedArchive& fused, const std::filesystem::path& file,
                        bool overwrite);

}  // namespace fude
