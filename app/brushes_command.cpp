#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "app/calibrate/written_file.h"
#include "app/commands.h"
#include "app/painting_options.h"
#include "rig/brush_view/brush_picture.h"
#include "rig/share_folder.h"
#include "sim/optics/png_file.h"

namespace fude {
namespace {

constexpr double rad_per_degree = std::numbers::pi / 180;
constexpr LoadBrush ink{0.8F, {1.2F, 0, 0, 0.4F}};

struct Listed {
  std::string name;
  BrushSpec spec;
};

Result<std::vector<Listed>> all_brushes() {
  std::vector<Listed> brushes;
  for (const std::string& name : shared_names("brushes", ".toml")) {
    const auto path = find_shared("brushes", name, ".toml");
    if (!path) return tl::unexpected(path.error());
    auto spec = read_brush_spec(path->string());
    if (!spec) return tl::unexpected(spec.error());
    brushes.push_back({name, std::move(*spec)});
  }
  return brushes;
}

// What a brush is for stands in the first remark of its file.
std::string remark_of(const std::string& name) {
  const auto path = find_shared("brushes", name, ".toml");
  return path ? first_remark(*path) : std::string();
}

double widest_mm(const BrushSpec& spec) {
  if (spec.spines > 1) return spec.row_width_mm;
  return 2 * std::max(spec.belly_radius_mm, spec.root_radius_mm);
}

// Each leaning over a stroke of its own.
Result<Picture> drawn(const BrushSpec& spec, TuftLook look) {
  const Eigen::Vector3d start(0, 0, 0.72 * spec.tuft_length_mm);
  auto posed = lead_to(spec, handle_pose(start, 0.3, 0, 0), ink);
  if (!posed) return tl::unexpected(posed.error());
  draw_stroke(*posed, 1.6 * spec.tuft_length_mm);
  PictureWish wish;
  wish.width = 420;
  wish.height = 420;
  wish.look = look;
  return picture_of(*posed, wish);
}

TuftLook look_named(const std::string& name) {
  return name == "colours" ? TuftLook::colours : name == "outline" ? TuftLook::outline : TuftLook::shaded;
}

void add_look(CLI::App& command, std::string& look) {
  command.add_option("--look", look, "shaded: bare hair; colours: with its ink; outline: its rim alone")
      ->check(CLI::IsMember({"shaded", "colours", "outline"}));
}

struct ListOptions {
  std::string out, look = "shaded";
  bool json = false, force = false;
};

Result<void> list(const ListOptions& options) {
  if (auto free = may_write(options.out, options.force); !free) return free;
  const auto brushes = all_brushes();
  if (!brushes) return tl::unexpected(brushes.error());
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  std::vector<Picture> pictures;
  for (const auto& [name, spec] : *brushes) {
    const std::string what = remark_of(name);
    if (options.json)
      rows.push_back({{"name", name},
                      {"what", what},
                      {"length_mm", spec.tuft_length_mm},
                      {"width_mm", widest_mm(spec)}});
    else
      std::printf("%-18s %5.1f mm long, %4.1f mm wide  %s\n", name.c_str(), spec.tuft_length_mm,
                  widest_mm(spec), what.c_str());
    if (options.out.empty()) continue;
    auto picture = drawn(spec, look_named(options.look));
    if (!picture) return tl::unexpected(picture.error());
    pictures.push_back(std::move(*picture));
  }
  if (options.json) std::printf("%s\n", rows.dump(2).c_str());
  if (options.out.empty()) return {};
  return write_png(options.out, contact_sheet(pictures), {.depth = 8, .overwrite = options.force});
}

struct ShowOptions {
  std::string name, pose, out, look = "shaded", size = "900x700";
  bool json = false, force = false;
};

// x,y,z and up to three angles, as one word.
Result<Pose<Paper, Handle>> pose_of(const std::string& text) {
  std::vector<double> values;
  std::istringstream words(text);
  for (std::string word; std::getline(words, word, ',');) {
    std::size_t end = 0;
    try {
      values.push_back(std::stod(word, &end));
    } catch (const std::exception&) {
      end = std::string::npos;
    }
    if (end != word.size()) {
      values.clear();
      break;
    }
  }
  if (values.size() < 3 || values.size() > 6)
    return failure(Fault::usage,
                   "--pose takes x,y,z[,lean[,towards[,spin]]] in millimetres and degrees, as 0,0,18,20,45");
  values.resize(6, 0);
  return handle_pose({values[0], values[1], values[2]}, rad_per_degree * values[3],
                     rad_per_degree * values[4], rad_per_degree * values[5]);
}

Result<PictureWish> wish_of(const ShowOptions& options) {
  PictureWish wish;
  wish.look = look_named(options.look);
  int end = 0;
  if (std::sscanf(options.size.c_str(), "%dx%d%n", &wish.width, &wish.height, &end) != 2 ||
      std::size_t(end) != options.size.size() || wish.width < 64 || wish.height < 64 || wish.width > 4096 ||
      wish.height > 4096)
    return failure(Fault::usage, "--size takes WxH in pixels, 64 to 4096 a side, as 900x700");
  return wish;
}

Result<void> show(const ShowOptions& options) {
  if (auto free = may_write(options.out, options.force); !free) return free;
  const auto pose = pose_of(options.pose);
  if (!pose) return tl::unexpected(pose.error());
  const auto wish = wish_of(options);
  if (!wish) return tl::unexpected(wish.error());
  const auto path = find_shared("brushes", options.name, ".toml");
  if (!path) return tl::unexpected(path.error());
  const auto spec = read_brush_spec(path->string());
  if (!spec) return tl::unexpected(spec.error());
  const auto posed = lead_to(*spec, *pose, ink);
  if (!posed) return tl::unexpected(posed.error());
  if (auto written =
          write_png(options.out, picture_of(*posed, *wish), {.depth = 8, .overwrite = options.force});
      !written)
    return written;
  const Eigen::Vector3d tip = posed->brush.shape().front().spine.back();
  const double stands = posed->brush.state().paper_from_handle.translation.z();
  if (options.json) {
    std::printf("%s\n", nlohmann::ordered_json{{"tip_mm", {tip.x(), tip.y(), tip.z()}},
                                               {"root_height_mm", stands},
                                               {"footprint_mm2", posed->mark.area_mm2()},
                                               {"energy_uj", posed->last.energy_mn_mm},
                                               {"frames", posed->frames},
                                               {"unconverged", posed->unconverged}}
                            .dump(2)
                            .c_str());
    return {};
  }
  std::printf("tip at %.2f, %.2f, %.2f mm; the root stands %.2f mm over the paper; %.1f mm2 covered\n",
              tip.x(), tip.y(), tip.z(), stands, posed->mark.area_mm2());
  if (posed->unconverged > 0)
    std::printf("%d of %d frames did not converge\n", posed->unconverged, posed->frames);
  return {};
}

}  // namespace

void add_brushes(CLI::App& app, int& status) {
  auto options = std::make_shared<ListOptions>();
  CLI::App* command = app.add_subcommand("brushes", "the brushes there are, listed and drawn");
  command->add_option("--out", options->out, "a picture of all, each on a stroke of its own (.png)");
  add_look(*command, options->look);
  command->add_flag("--json", options->json, "as JSON");
  command->add_flag("--force", options->force, "replace an existing file");
  auto shown = std::make_shared<ShowOptions>();
  CLI::App* one = command->add_subcommand("show", "draws one in a pose over the paper, solved");
  one->add_option("NAME", shown->name, "a brush of share/brushes, or a TOML file")->required();
  one->add_option(
         "--pose", shown->pose,
         "where the root of the hair is: x,y,z[,lean[,towards[,spin]]], mm over the paper and degrees")
      ->required();
  one->add_option("--out", shown->out, "the picture to write (.png)")->required();
  add_look(*one, shown->look);
  one->add_option("--size", shown->size, "of the picture, WxH pixels");
  one->add_flag("--json", shown->json, "figures as JSON");
  one->add_flag("--force", shown->force, "replace an existing file");
  command->callback([options, command, &status] {
    if (!command->get_subcommands().empty()) return;
    if (const auto done = list(*options); !done) status = report(done.error());
  });
  one->callback([shown, &status] {
    if (const auto done = show(*shown); !done) status = report(done.error());
  });
}

}  // namespace fude
