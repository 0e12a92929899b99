// Trials of a real brush as a folder: pictures of the marks that it left, the poses that led to each, and a
// list. docs/calibration.md describes the files.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "signal/grey_image.h"
#include "signal/result.h"
#include "sim/brush/twin_trial.h"

namespace fude {

// Reads `folder`/trials.toml and what it names. Errors: not_found, naming the file; malformed, with the line
// or the trial; also for a picture that shows no mark, and for a hand that never comes near the paper or goes
// back in time.
Result<std::vector<TwinTrial>> read_twin_trials(const std::filesystem::path& folder);

// t_s,x_mm,y_mm,z_mm,qw,qx,qy,qz[,force_n], a line a moment; # begins a remark. Errors: malformed.
Result<std::vector<HandMoment>> hand_from(std::string_view text, const std::string& source);

// Dark ink on light paper as cover from 0 to 1, between the grey of the paper and that of the ink. Errors:
// malformed, where the two can hardly be told apart, or the mark runs out of the picture.
Result<Mark> mark_in(const GreyImage& picture, double mm_per_pixel, double left_mm, double bottom_mm,
                     const std::string& source);

}  // namespace fude
