#include "app/studio/tuft_drawing.h"

#include <epoxy/gl.h>
#include <imgui.h>

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "sim/optics/srgb.h"

namespace fude {
namespace {

constexpr double opacity = 0.72;
constexpr int samples = 2;                   // a side of a pixel
constexpr double finest_pixels = 420;        // of the hair's extent: beyond it the picture is enlarged
const Eigen::Vector2d rise_per_mm(0, 0.25);  // seen a little from the painter's side: height leans away

constexpr ImU32 bone = IM_COL32(30, 60, 160, 255);
constexpr ImU32 rib = IM_COL32(40, 120, 190, 255);
constexpr ImU32 contact = IM_COL32(220, 120, 0, 255);
constexpr ImU32 plane = IM_COL32(160, 0, 160, 255);
constexpr ImU32 alarm = IM_COL32(230, 0, 0, 255);

double extent_mm(std::span<const SeenTuft> tufts) {
  double most = 1;
  for (const SeenTuft& tuft : tufts)
    for (const Station& s : tuft.surface)
      most = std::max(most, (s.centre - tufts.front().surface.front().centre).norm() + s.major_a + s.major_b);
  return most;
}

// As OpenGL blends it: codes of sRGB, not multiplied by the opacity.
std::vector<std::uint8_t> codes_of(const TintedImage& image) {
  std::vector<std::uint8_t> codes;
  codes.reserve(4 * image.pixels.size());
  for (const Tint& pixel : image.pixels) {
    const double covered = std::max(1e-6, static_cast<double>(pixel[3]));
    for (int band = 0; band < 3; ++band)
      codes.push_back(
          static_cast<std::uint8_t>(srgb16_from_linear(static_cast<double>(pixel[band]) / covered) >> 8));
    codes.push_back(static_cast<std::uint8_t>(std::clamp(255 * pixel[3] + 0.5F, 0.0F, 255.0F)));
  }
  return codes;
}

ImVec2 point(const Eigen::Vector2d& p) { return {static_cast<float>(p.x()), static_cast<float>(p.y())}; }

ImVec2 on_screen(const View& view, const Eigen::Vector3d& p) {
  return point(view.to_window(p.head<2>() + p.z() * rise_per_mm));
}

}  // namespace

TuftDrawing::TuftDrawing(Palette palette) : palette_(std::move(palette)) {
  glGenTextures(1, &texture_);
  glBindTexture(GL_TEXTURE_2D, texture_);
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    glTexParameteri(GL_TEXTURE_2D, filter, GL_LINEAR);
  for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
    glTexParameteri(GL_TEXTURE_2D, wrap, GL_CLAMP_TO_EDGE);
}

TuftDrawing::~TuftDrawing() { glDeleteTextures(1, &texture_); }

void TuftDrawing::draw(ImDrawList& canvas, const View& view, std::span<const SeenTuft> tufts, TuftLook look) {
  if (look == TuftLook::off || tufts.empty() || tufts.front().surface.empty()) return;
  const double shrink = std::min(1.0, finest_pixels / (view.pixels_per_mm * extent_mm(tufts)));
  const Projection projection =
      oblique(shrink * view.pixels_per_mm, shrink * view.to_window(Eigen::Vector2d::Zero()), rise_per_mm);
  const PixelBox window{0, 0, static_cast<int>(shrink * view.window.x()),
                        static_cast<int>(shrink * view.window.y())};
  std::vector<TriangleLayer> layers =
      tuft_layers(tufts, look, opacity, palette_, projection, window, samples);
  for (TriangleLayer& shadow : shadow_layers(tufts, projection, window, samples))
    layers.push_back(std::move(shadow));
  const TintedImage image = blend(layers);
  if (image.pixels.empty()) return;
  glBindTexture(GL_TEXTURE_2D, texture_);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, image.box.columns, image.box.rows, 0, GL_RGBA, GL_UNSIGNED_BYTE,
               codes_of(image).data());
  const Eigen::Vector2d corner = Eigen::Vector2d(image.box.left, image.box.top) / shrink;
  const Eigen::Vector2d size = Eigen::Vector2d(image.box.columns, image.box.rows) / shrink;
  canvas.AddImage(reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(texture_)), point(corner),
                  point(corner + size));
}

void draw_insides(ImDrawList& canvas, const View& view, const BrushShape& brush, const TuftInsides& insides,
                  bool converged) {
  for (const TuftShape& tuft : brush)
    for (std::size_t k = 0; k < tuft.spine.size(); ++k) {
      const ImVec2 node = on_screen(view, tuft.spine[k]);
      if (k > 0)
        canvas.AddLine(on_screen(view, tuft.spine[k - 1]), node, converged ? bone : alarm,
                       converged ? 2.0F : 4.0F);
      canvas.AddLine(on_screen(view, tuft.lateral_a[k]), on_screen(view, tuft.lateral_b[k]), rib, 1.5F);
      canvas.AddCircleFilled(node, 3, converged ? bone : alarm);
    }
  for (const TuftInsides::Contact& touch : insides.contacts) {
    canvas.AddCircle(on_screen(view, touch.node), 5, contact, 0, 1.5F);
    canvas.AddLine(on_screen(view, touch.node), point(view.to_window(touch.anchor)), contact, 1.5F);
  }
  for (const auto& line : insides.planes)
    canvas.AddLine(point(view.to_window(line[0])), point(view.to_window(line[1])), plane, 3);
  if (!converged && !brush.empty())
    canvas.AddText(on_screen(view, brush.front().spine.front()), alarm, "not converged");
}

}  // namespace fude
