#include "rig/calibration/pressure.h"

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "app/calibrate/procedure_command.h"
#include "app/calibrate/procedures.h"

namespace fude {
namespace {

struct Options {
  std::string tablet;
  std::vector<double> grams;
  std::filesystem::path weighings;

  Result<PressureWish> wished() const {
    PressureWish wish{tablet, {}};
    if (grams.empty() == weighings.empty())
      return failure(Fault::usage,
                     "pressure needs what the scale showed: --grams g1,g2,… or --weighings FILE");
    for (const double g : grams) wish.weighings.push_back({g, std::nullopt});
    if (grams.empty()) {
      auto timed = read_weighings(weighings);
      if (!timed) return tl::unexpected(timed.error());
      wish.weighings = std::move(*timed);
    }
    return wish;
  }
};

}  // namespace

void add_calibrate_pressure(CLI::App& calibrate, int& status) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      add_procedure(calibrate, status,
                    {"pressure", "a pen's pressure in newtons, from presses on a kitchen scale",
                     [options](const KnownCalibrations&) -> Result<std::unique_ptr<Calibrator>> {
                       auto wish = options->wished();
                       if (!wish) return tl::unexpected(wish.error());
                       return pressure_calibrator(std::move(*wish));
                     }});
  command->add_option("--tool", options->tablet, "the tablet, where there are several");
  command->add_option("--grams", options->grams, "what the scale showed, for each press in its order")
      ->delimiter(',')
      ->allow_extra_args(false);
  command->add_option("--weighings", options->weighings,
                      "a list of host_s,grams instead: when the scale showed what");
}

}  // namespace fude
