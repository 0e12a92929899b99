#include "app/numbers_option.h"

#include <cstdio>
#include <utility>

namespace fude {

// As one word: CLI11 would take what follows for more numbers.
CLI::Option* add_numbers_option(CLI::App& command, const std::string& name, const std::string& meaning,
                                std::function<void(const Eigen::Vector3d&)> take) {
  return command.add_option_function<std::string>(
      name,
      [name, take = std::move(take)](const std::string& text) {
        Eigen::Vector3d v;
        int length = 0;
        if (std::sscanf(text.c_str(), "%lf,%lf,%lf%n", &v.x(), &v.y(), &v.z(), &length) != 3 ||
            text[std::size_t(length)] != '\0' || !v.allFinite())
          throw CLI::ValidationError(name, "give three numbers, as 0.5,-12,150");
        take(v);
      },
      meaning);
}

}  // namespace fude
