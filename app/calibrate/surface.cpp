#include "rig/calibration/surface.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>

#include "app/calibrate/procedure_command.h"
#include "app/calibrate/procedures.h"
#include "app/painting_options.h"
#include "rig/calibration/tablet.h"

namespace fude {
namespace {

struct Options {
  SurfaceWish touched;
  std::string taps, sheet_mm;
  std::filesystem::path places;

  bool of_a_tablet() const { return !taps.empty() || !places.empty(); }

  Result<TapSheet> tap_sheet() const {
    if (sheet_mm.empty())
      return failure(Fault::usage, "a tablet's surface needs the sheet that is tapped: --sheet-mm WxH");
    const auto sheet = parse_extent(sheet_mm, "--sheet-mm");
    if (!sheet) return tl::unexpected(sheet.error());
    if (!places.empty()) return listed_taps(places, sheet->width.value, sheet->height.value);
    int columns = 0, rows = 0, length = 0;
    constexpr int most = 15;  // a smooth warp through more would take long
    if (std::sscanf(taps.c_str(), "%dx%d%n", &columns, &rows, &length) != 2 ||
        taps[std::size_t(length)] != '\0' || columns < 2 || rows < 2 || columns > most || rows > most)
      return failure(Fault::usage, "--taps takes COLUMNSxROWS, as 5x5, from 2 to 15; '" + taps + "' is not");
    return tap_grid(columns, rows, sheet->width.value, sheet->height.value);
  }

  Result<std::unique_ptr<Calibrator>> calibrator(KnownCalibrations known) const {
    if (!of_a_tablet()) {
      if (!sheet_mm.empty())
        return failure(Fault::usage, "--sheet-mm goes with --taps or --landmarks, the places of a tablet");
      return surface_calibrator(touched, std::move(known));
    }
    auto sheet = tap_sheet();
    if (!sheet) return tl::unexpected(sheet.error());
    return tablet_calibrator({touched.tool.tool, std::move(*sheet)});
  }
};

}  // namespace

void add_calibrate_surface(CLI::App& calibrate, int& status) {
  auto options = std::make_shared<Options>();
  CLI::App* command = add_procedure(
      calibrate, status,
      {"surface",
       "the painting surface and its paper, from touches of a calibrated tip; a tablet's, from taps",
       [options](KnownCalibrations known) { return options->calibrator(std::move(known)); }});
  add_tool_options(*command, options->touched.tool);
  add_tip_option(*command, options->touched.tip_m);
  command->add_flag("--corners", options->touched.corners_first,
                    "the first four touches are the paper's corners, lower left first, counter-clockwise");
  auto* taps = command->add_option("--taps", options->taps,
                                   "of a tablet: a grid COLUMNSxROWS over the sheet, tapped row by row from "
                                   "the upper left");
  command
      ->add_option("--landmarks", options->places,
                   "of a tablet: the places instead, a list of name,x,y,z in mm from the lower left corner")
      ->excludes(taps);
  command->add_option("--sheet-mm", options->sheet_mm, "of a tablet: the sheet that is tapped, WxH");
}

}  // namespace fude
