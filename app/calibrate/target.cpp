// A board to be printed, for `fude calibrate camera`.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>

#include "app/calibrate/board_options.h"
#include "app/calibrate/procedures.h"
#include "app/calibrate/written_file.h"
#include "app/commands.h"
#include "rig/calibration/printed_target.h"

namespace fude {
namespace {

struct Options {
  BoardOptions board;
  std::string page = "a4", out;
  bool force = false;
};

Result<void> print_target(const Options& options) {
  const bool png = options.out.ends_with(".png");
  if (!png && !options.out.ends_with(".pdf")) return failure(Fault::usage, "--out is a .pdf or a .png");
  if (auto free = may_write(options.out, options.force); !free) return free;
  const auto page = printed_target(options.board.board(), options.page);
  if (!page) return tl::unexpected(page.error());
  const auto bytes = png ? png_of(*page) : Result<std::string>(pdf_of(*page));
  if (!bytes) return tl::unexpected(bytes.error());
  if (auto written = write_file(options.out, *bytes); !written) return written;
  std::printf("%s: %g x %g mm; print it at 100 %% and measure the line of 100 mm\n", options.out.c_str(),
              page->size_mm.x(), page->size_mm.y());
  return {};
}

}  // namespace

void add_calibrate_target(CLI::App& calibrate, int& status) {
  auto options = std::make_shared<Options>();
  CLI::App* command = calibrate.add_subcommand("target", "a board to be printed at true scale");
  add_board_options(*command, options->board);
  command->add_option("--page", options->page, "a4, a3 or letter");
  command->add_option("--out", options->out, "the page to write (.pdf or .png)")->required();
  command->add_flag("--force", options->force, "replace an existing file");
  command->callback([options, &status] {
    if (const auto done = print_target(*options); !done) status = report(done.error());
  });
}

}  // namespace fude
