#include "app/painting_options.h"

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <thread>

#include "rig/share_folder.h"
#include "sim/brush/brush_spec.h"
#include "sim/ink/paper.h"

namespace fude {
namespace {

std::optional<double> number(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

Result<Settle> parse_settle(const std::string& text) {
  if (text == "dry") return Settle{.until_dry = true};
  const auto seconds = number(text);
  if (!seconds || *seconds < 0 || *seconds > 36000)
    return failure(Fault::usage, "--settle takes seconds from 0 to 36000, or 'dry'");
  return Settle{.seconds = *seconds};
}

}  // namespace

Result<Extent> parse_extent(const std::string& text, const std::string& option) {
  const std::size_t cross = text.find('x');
  if (cross != std::string::npos) {
    const auto width = number(std::string_view(text).substr(0, cross));
    const auto height = number(std::string_view(text).substr(cross + 1));
    if (width && height && *width > 0 && *height > 0)
      return Extent{Millimetres(*width), Millimetres(*height)};
  }
  return failure(Fault::usage, option + " takes WxH in millimetres, as 210x297; '" + text + "' is not");
}

void PaintingOptions::add_to(CLI::App& command) {
  command.add_option("--brush", brush, "a brush of share/brushes, or a TOML file");
  command.add_option("--paper", paper, "a paper of share/papers, or a TOML file");
  command.add_option("--size-mm", size_mm, "the sheet, WxH; default: the tablet's active area");
  command.add_option("--tablet-mm", tablet_mm, "active area of a tablet that does not say it, WxH");
  command.add_option("--cell-mm", cell_mm, "cell of the paper, one pixel of the picture");
  command.add_option("--ink", ink, "endless: the brush stays full")
      ->check(CLI::IsMember({"normal", "endless"}));
  command.add_option("--flow", flow, "off: strokes are laid down dry")->check(CLI::IsMember({"on", "off"}));
  command.add_option("--settle", settle, "seconds to go on after the last input, or 'dry'");
  command.add_option("--backend", backend, "what runs the ink")->check(CLI::IsMember({"cpu", "gl", "auto"}));
  command.add_option("--isa", isa, "instructions of the CPU back-end")
      ->check(CLI::IsMember({"sse2", "avx2", "avx512", "auto"}));
  command.add_option("--threads", threads, "of the CPU back-end; 0: as many as processors");
}

Result<ReplaySettings> PaintingOptions::settings() const {
  ReplaySettings settings;
  const auto brush_file = find_shared("brushes", brush, ".toml");
  if (!brush_file) return tl::unexpected(brush_file.error());
  auto brush_spec = read_brush_spec(brush_file->string());
  if (!brush_spec) return tl::unexpected(brush_spec.error());
  const auto paper_file = find_shared("papers", paper, ".toml");
  if (!paper_file) return tl::unexpected(paper_file.error());
  auto paper_spec = load_paper(*paper_file);
  if (!paper_spec) return tl::unexpected(paper_spec.error());

  if (!(cell_mm >= 0.01 && cell_mm <= 2))
    return failure(Fault::usage, "--cell-mm takes 0.01 to 2 millimetres");
  if (threads < 0 || threads > 256) return failure(Fault::usage, "--threads takes 0 to 256");
  if (!size_mm.empty()) {
    const auto size = parse_extent(size_mm, "--size-mm");
    if (!size) return tl::unexpected(size.error());
    settings.wish.sheet = *size;
  }
  if (!tablet_mm.empty()) {
    const auto size = parse_extent(tablet_mm, "--tablet-mm");
    if (!size) return tl::unexpected(size.error());
    settings.wish.tablet = *size;
  }
  const auto until = parse_settle(settle);
  if (!until) return tl::unexpected(until.error());
  settings.settle = *until;

  settings.reach = reach_of(*brush_spec);
  settings.painting.brush = std::move(*brush_spec);
  settings.painting.endless = ink == "endless";
  InkSetup& setup = settings.painting.ink;
  setup.paper = std::move(*paper_spec);
  setup.cell_mm = cell_mm;
  setup.flow = flow == "on";
  setup.threads = threads > 0 ? threads : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  setup.instruction_set = instruction_set_named(isa);
  setup.backend = backend == "auto" ? best_ink_backend() : backend == "gl" ? InkBackend::gl : InkBackend::cpu;
  settings.palette.pigments = {pigments()[0]};
  return settings;
}

}  // namespace fude
