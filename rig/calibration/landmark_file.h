// A list of landmarks as text: a line each, `name,x,y,z` in millimetres; # begins a remark.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "calibration/landmarks.h"
#include "signal/result.h"

namespace fude {

// Errors: malformed, with the line; also for a name that stands twice, and an empty list.
Result<std::vector<Landmark>> landmarks_from(std::string_view text, const std::string& source);
// Also: not_found.
Result<std::vector<Landmark>> read_landmarks(const std::filesystem::path& file);

// Points of `measured` in the order of `listed`: by name where each name is in both, else as they stand.
std::vector<Eigen::Vector3d> in_order_of(const std::vector<Landmark>& listed,
                                         const std::vector<Landmark>& measured);

}  // namespace fude
