#include "rig/fusion/fuse_sources.h"

#include <algorithm>
#include <string>

namespace fude {

Result<std::set<FuseSource>> fuse_sources(std::string_view names) {
  std::set<FuseSource> sources;
  while (!names.empty()) {
    const std::string_view name = names.substr(0, names.find(','));
    names.remove_prefix(std::min(names.size(), name.size() + 1));
    if (name == "imu") {
      sources.insert({FuseSource::gyro, FuseSource::accel, FuseSource::mag});
      continue;
    }
    const auto found = std::find_if(fuse_source_names.begin(), fuse_source_names.end(),
                                    [&](const auto& known) { return known.first == name; });
    if (found == fuse_source_names.end())
      return failure(Fault::usage,
                     "there is no source \"" + std::string(name) +
                         "\"; name some of imu, gyro, accel, mag, pose, position, range, contact, "
                         "opt_pose, opt_position, with a comma between them");
    sources.insert(found->second);
  }
  if (sources.empty()) return failure(Fault::usage, "--use names no source");
  return sources;
}

}  // namespace fude
