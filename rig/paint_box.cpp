#include "rig/paint_box.h"

#include <toml++/toml.h>

#include <fstream>
#include <iterator>

#include "rig/share_folder.h"

namespace fude {
namespace {

Error wrong(const std::string& source, const std::string& what) {
  return {Fault::malformed, source + ": " + what};
}

}  // namespace

Result<PaintBox> read_paint_box(std::string_view text, const std::string& source) {
  toml::table table;
  try {
    table = toml::parse(text, source);
  } catch (const toml::parse_error& e) {
    return tl::unexpected(
        wrong(source, "line " + std::to_string(e.source().begin.line) + ": " + std::string(e.description())));
  }
  PaintBox box;
  box.toml = text;
  box.name = table["name"].value_or("");
  const toml::array* names = table["pigments"].as_array();
  if (!names || names->empty() || names->size() > glue_channel)
    return tl::unexpected(wrong(source, "a palette has pigments, one to three names"));
  for (const toml::node& node : *names) {
    auto pigment = find_pigment(node.value_or(std::string_view{}));
    if (!pigment) return tl::unexpected(pigment.error());
    box.pigments.push_back(*pigment);
  }
  return box;
}

Result<PaintBox> find_paint_box(const std::string& name) {
  const auto file = find_shared("palettes", name, ".toml");
  if (!file) return tl::unexpected(file.error());
  std::ifstream in(*file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  if (!in) return failure(Fault::not_found, "cannot read the palette " + file->string());
  return read_paint_box(text, file->string());
}

}  // namespace fude
