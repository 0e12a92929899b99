#include "sim/ink/gl_tile_texels.h"

#include <array>
#include <utility>

#include "sim/ink/kernels/lang_cpp.h"

namespace fude {
namespace {

// clang-format off
#include "sim/ink/kernels/numeric.k"
#include "sim/ink/kernels/site.k"
#include "sim/ink/kernels/shown.k"
// clang-format on

constexpr std::size_t second = floats_a_texel;  // of a pair
constexpr std::size_t pair_stride = 2 * floats_a_texel;

// Where the texels keep the planes.
using Place = std::pair<std::size_t, std::size_t>;  // plane, float of the first cell
constexpr std::array<Place, 8> moving_places = {{{tile::e, 0},
                                                 {tile::n, 1},
                                                 {tile::w, 2},
                                                 {tile::s, 3},
                                                 {tile::ne, second},
                                                 {tile::nw, second + 1},
                                                 {tile::sw, second + 2},
                                                 {tile::se, second + 3}}};
constexpr std::size_t surface_mass = tile::still_begin + tile::surface_mass;
constexpr std::array<Place, 6> surface_places = {{{surface_mass, 0},
                                                  {surface_mass + 1, 1},
                                                  {surface_mass + 2, 2},
                                                  {surface_mass + 3, 3},
                                                  {tile::still_begin + tile::surface, second},
                                                  {tile::rest, second + 1}}};
constexpr std::size_t fixed_mass = tile::still_begin + tile::fixed_mass;
constexpr std::array<Place, 8> pigment_places = {{{tile::mass, 0},
                                                  {tile::mass + 1, 1},
                                                  {tile::mass + 2, 2},
                                                  {tile::mass + 3, 3},
                                                  {fixed_mass, second},
                                                  {fixed_mass + 1, second + 1},
                                                  {fixed_mass + 2, second + 2},
                                                  {fixed_mass + 3, second + 3}}};
constexpr std::array<Place, 3> paper_places = {{{tile::paper_begin + tile::blocking, 0},
                                                {tile::paper_begin + tile::grain, 1},
                                                {tile::paper_begin + tile::toe, 2}}};

template <class Visit>
void visit_cells(const Visit& visit) {
  for (int y = 0; y < tile::side; ++y)
    for (int x = 0; x < tile::side; ++x) visit(x, y, static_cast<std::size_t>(y * tile::side + x));
}

template <std::size_t n>
void take(const PlaneView& planes, const std::array<Place, n>& places, std::size_t stride,
          std::vector<float>& texels) {
  for (const auto& [plane, first] : places)
    visit_cells([&, p = plane, at = first](int x, int y, std::size_t cell) {
      texels[at + stride * cell] = planes.cells(p, y)[x];
    });
}

template <std::size_t n>
void give(std::span<const float> texels, const std::array<Place, n>& places, const PlaneView& planes) {
  for (const auto& [plane, first] : places)
    visit_cells([&, p = plane, at = first](int x, int y, std::size_t cell) {
      planes.cells(p, y)[x] = texels[at + pair_stride * cell];
    });
}

// In the order the step sums it.
float fixed_ink(const float* fixed) { return (fixed[0] + fixed[1]) + (fixed[2] + fixed[3]); }

vec4 vec4_at(const float* f) { return {f[0], f[1], f[2], f[3]}; }

void put(const vec4& v, float* to) {
  to[0] = v.x;
  to[1] = v.y;
  to[2] = v.z;
  to[3] = v.w;
}

}  // namespace

TileTexels texels_of(const LatticeNumbers& numbers, const PlaneView& planes) {
  const std::vector<float> pair(pair_floats);
  TileTexels t{pair, pair, pair, pair, std::vector<float>(paper_floats)};
  take(planes, moving_places, pair_stride, t.moving);
  take(planes, surface_places, pair_stride, t.surface);
  take(planes, pigment_places, pair_stride, t.pigment);
  take(planes, paper_places, floats_a_texel, t.paper);
  for (std::size_t at = 0; at < pair_floats; at += pair_stride) {
    const float* straight = &t.moving[at];
    const float* diagonal = &t.moving[second + at];
    const float* paper = &t.paper[at / 2];
    const Population f = {t.surface[second + at + 1],
                          straight[0],
                          straight[1],
                          straight[2],
                          straight[3],
                          diagonal[0],
                          diagonal[1],
                          diagonal[2],
                          diagonal[3]};
    const Shown s = shown(site_of(numbers, total(f), vec4_at(&t.pigment[at]),
                                  fixed_ink(&t.pigment[second + at]), paper[0], paper[1], paper[2]));
    put(s.concentration, &t.shown[at]);
    put(s.front, &t.shown[second + at]);
  }
  return t;
}

void fill_planes(std::span<const float> moving, std::span<const float> surface,
                 std::span<const float> pigment, const PlaneView& planes) {
  give(moving, moving_places, planes);
  give(surface, surface_places, planes);
  give(pigment, pigment_places, planes);
  for (std::size_t cell = 0; cell < tile::cells; ++cell)
    planes.cells(tile::fixed_ink, static_cast<int>(cell) / tile::side)[cell % tile::side] =
        fixed_ink(&pigment[second + pair_stride * cell]);
}

std::vector<float> fixed_masses(std::span<const float> pigment) {
  std::vector<float> masses(floats_a_texel * tile::cells);
  for (std::size_t i = 0; i < masses.size(); ++i)
    masses[i] = pigment[i % tile::cells * pair_stride + second + i / tile::cells];
  return masses;
}

}  // namespace fude
