#include "app/painting_options.h"

#include <CLI/CLI.hpp>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <thread>

#include "rig/calibrated_tablets.h"
#include "rig/paint_box.h"
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

// Reads back as the same number.
std::string shortest(double value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

Result<Settle> parse_settle(const std::string& text) {
  if (text == "dry") return Settle{.until_dry = true};
  const auto seconds = number(text);
  if (!seconds || *seconds < 0 || *seconds > 36000)
    return failure(Fault::usage, "--settle takes seconds from 0 to 36000, or 'dry'");
  return Settle{.seconds = *seconds};
}

}  // namespace

std::string as_text(Extent extent) {
  return shortest(extent.width.value) + "x" + shortest(extent.height.value);
}

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
  command.add_option("--brush", brush,
                     "a brush of share/brushes, or a TOML file; default: the session's, else round-goat");
  command.add_option("--paper", paper,
                     "a paper of share/papers, or a TOML file; default: the session's, else xuan");
  command.add_option("--palette", palette,
                     "a palette of share/palettes, or a TOML file; default: the session's, else ink");
  command.add_option("--manner", manner,
                     "how a brush is held whose device does not sense its lean: upright, hand, left-hand, "
                     "travel, fixed or fixed:RIGHT,TOWARDS in degrees; default: the session's, else upright");
  command.add_option("--size-mm", size_mm,
                     "the sheet, WxH; default: the session's, else the tablet's active area");
  command.add_option("--tablet-mm", tablet_mm, "active area of a tablet that does not say it, WxH");
  command
      .add_option("--cal", calibrations,
                  "a tablet's calibration by taps (may be given several times); default: the session's")
      ->take_all()
      ->expected(1);
  command.add_option("--cell-mm", cell_mm,
                     "cell of the paper, one pixel of the picture; default: the session's, else 0.1");
  command.add_option("--ink", ink, "normal, or endless: the brush stays full")
      ->check(CLI::IsMember({"normal", "endless"}));
  command.add_option("--flow", flow, "on, or off: strokes are laid down dry")
      ->check(CLI::IsMember({"on", "off"}));
  command.add_option("--settle", settle, "seconds to go on after the last input, or 'dry'");
  command.add_option("--backend", backend, "what runs the ink")->check(CLI::IsMember({"cpu", "gl", "auto"}));
  command.add_option("--isa", isa, "instructions of the CPU back-end")
      ->check(CLI::IsMember({"sse2", "avx2", "avx512", "auto"}));
  command.add_option("--threads", threads, "of the CPU back-end; 0: as many as processors");
}

namespace {

// Text of a file of share/`kind`, or of the session where none is named.
struct Named {
  std::string text;
  std::string source;
};

Result<Named> named(const std::string& kind, const std::string& name, const RecordedSettings& recorded,
                    const std::string& key, const std::string& standard) {
  if (const auto known = recorded.find(key); name.empty() && known != recorded.end())
    return Named{known->second, "the session's " + key};
  const auto path = find_shared(kind, name.empty() ? standard : name, ".toml");
  if (!path) return tl::unexpected(path.error());
  std::ifstream file(*path, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  if (!file) return failure(Fault::not_found, "cannot read the " + key + " " + path->string());
  return Named{std::move(text), path->string()};
}

std::string given(const std::string& option, const RecordedSettings& recorded, const std::string& key,
                  const std::string& standard) {
  if (!option.empty()) return option;
  const auto known = recorded.find(key);
  return known == recorded.end() ? standard : known->second;
}

}  // namespace

Result<ReplaySettings> PaintingOptions::settings(const RecordedSettings& recorded) const {
  ReplaySettings settings;
  const auto brush_text = named("brushes", brush, recorded, "brush", "round-goat");
  if (!brush_text) return tl::unexpected(brush_text.error());
  auto brush_spec = parse_brush_spec(brush_text->text, brush_text->source);
  if (!brush_spec) return tl::unexpected(brush_spec.error());
  const auto paper_text = named("papers", paper, recorded, "paper", "xuan");
  if (!paper_text) return tl::unexpected(paper_text.error());
  auto paper_spec = read_paper(paper_text->text, paper_text->source);
  if (!paper_spec) return tl::unexpected(paper_spec.error());

  const auto box_text = named("palettes", palette, recorded, "palette", "ink");
  if (!box_text) return tl::unexpected(box_text.error());
  const auto box = read_paint_box(box_text->text, box_text->source);
  if (!box) return tl::unexpected(box.error());

  const auto cell = number(given(cell_mm, recorded, "cell_mm", "0.1"));
  if (!cell || !(*cell >= 0.02 && *cell <= 1))
    return failure(Fault::usage, "--cell-mm takes 0.02 to 1 millimetre");
  if (threads < 0 || threads > 256) return failure(Fault::usage, "--threads takes 0 to 256");
  if (const std::string sheet = given(size_mm, recorded, "sheet_mm", ""); !sheet.empty()) {
    const auto size = parse_extent(sheet, "--size-mm");
    if (!size) return tl::unexpected(size.error());
    settings.wish.sheet = *size;
  }
  if (!tablet_mm.empty()) {
    const auto size = parse_extent(tablet_mm, "--tablet-mm");
    if (!size) return tl::unexpected(size.error());
    settings.wish.tablet = *size;
  }
  for (const std::string& file : calibrations) {
    auto calibration = tablet_calibration(file);
    if (!calibration) return tl::unexpected(calibration.error());
    settings.wish.calibrations.push_back(std::move(*calibration));
  }
  const auto held = parse_manner(given(manner, recorded, "manner", "upright"));
  if (!held) return tl::unexpected(held.error());
  settings.wish.manner = *held;
  const auto until = parse_settle(settle);
  if (!until) return tl::unexpected(until.error());
  settings.settle = *until;

  settings.reach = reach_of(*brush_spec);
  settings.painting.brush = std::move(*brush_spec);
  const std::string supply = given(ink, recorded, "ink", "normal");
  settings.painting.endless = supply == "endless";
  InkSetup& setup = settings.painting.ink;
  setup.paper = std::move(*paper_spec);
  setup.cell_mm = *cell;
  const std::string flowing = given(flow, recorded, "flow", "on");
  setup.flow = flowing != "off";
  setup.threads = threads > 0 ? threads : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  setup.instruction_set = instruction_set_named(isa);
  setup.backend = backend == "auto" ? best_ink_backend() : backend == "gl" ? InkBackend::gl : InkBackend::cpu;
  settings.palette.pigments = box->pigments;
  settings.painting.spots = box->spots;
  settings.to_record = {{"brush", brush_text->text},
                        {"paper", paper_text->text},
                        {"palette", box_text->text},
                        {"cell_mm", shortest(*cell)},
                        {"ink", supply},
                        {"flow", flowing},
                        {"manner", as_text(*held)}};
  return settings;
}

}  // namespace fude
