// An option of three numbers in one word: x,y,z.
#pragma once

#include <CLI/CLI.hpp>
#include <Eigen/Core>
#include <functional>
#include <string>

namespace fude {

// `take` gets the three, all finite; anything else is wrong usage.
CLI::Option* add_numbers_option(CLI::App& command, const std::string& name, const std::string& meaning,
                                std::function<void(const Eigen::Vector3d&)> take);

}  // namespace fude
