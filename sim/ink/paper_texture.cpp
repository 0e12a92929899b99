#include "sim/ink/paper_texture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "signal/elementary.h"

namespace fude {
namespace {

// Splitmix64 (Steele, Lea, Flood 2014): a counter to well-mixed bits.
std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

enum class Kind : std::uint64_t { fibre = 1, pin, alum, cloud, fine_cloud };

// Numbers that belong to one square of the sheet.
class Draw {
 public:
  Draw(std::uint64_t seed, Kind kind, int column, int row)
      : state_(
            mixed(mixed(mixed(seed + static_cast<std::uint64_t>(kind)) + static_cast<std::uint32_t>(column)) +
                  static_cast<std::uint32_t>(row))) {}

  // From 0 up to, not including, 1.
  double operator()() {
    state_ = mixed(state_);
    return static_cast<double>(state_ >> 11) * 0x1p-53;
  }

 private:
  std::uint64_t state_;
};

struct Place {
  double x;
  double y;
};

// The cells of one tile, in millimetres.
struct Frame {
  double left;
  double bottom;
  double cell;
  double size() const { return cell * tile::side; }
};

double squared_distance(Place p, Place a, Place b) {
  const double dx = b.x - a.x;
  const double dy = b.y - a.y;
  const double along =
      std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / (dx * dx + dy * dy + 1e-30), 0.0, 1.0);
  const double x = p.x - a.x - along * dx;
  const double y = p.y - a.y - along * dy;
  return x * x + y * y;
}

// Calls paint(cell, profile) for the cells near a segment; the profile falls from 1 on it to 0 at half.
template <class Paint>
void stroke_segment(const Frame& frame, Place a, Place b, double half, const Paint& paint) {
  const auto cells = [&](double low, double high, double origin) {
    return std::array{
        std::max(0, static_cast<int>(std::floor((low - half - origin) / frame.cell))),
        std::min(tile::side - 1, static_cast<int>(std::floor((high + half - origin) / frame.cell)))};
  };
  if (std::max(a.x, b.x) + half < frame.left || std::min(a.x, b.x) - half > frame.left + frame.size() ||
      std::max(a.y, b.y) + half < frame.bottom || std::min(a.y, b.y) - half > frame.bottom + frame.size())
    return;
  const auto columns = cells(std::min(a.x, b.x), std::max(a.x, b.x), frame.left);
  const auto rows = cells(std::min(a.y, b.y), std::max(a.y, b.y), frame.bottom);
  for (int y = rows[0]; y <= rows[1]; ++y)
    for (int x = columns[0]; x <= columns[1]; ++x) {
      const Place p{frame.left + (x + 0.5) * frame.cell, frame.bottom + (y + 0.5) * frame.cell};
      const double q = squared_distance(p, a, b) / (half * half);
      if (q < 1) paint(static_cast<std::size_t>(y * tile::side + x), (1 - q) * (1 - q));
    }
}

// Calls seed(draw, start) for everything that begins within `reach` of the tile, `density` in a square
// millimetre.
template <class Seed>
void for_each_seed(const Frame& frame, std::uint64_t seed, Kind kind, double density, double reach,
                   const Seed& grow) {
  if (density <= 0) return;
  // Squares as large as what grows from them: whatever reaches the tile begins in one that touches it.
  const auto square = [&](double x) { return static_cast<int>(std::floor(x / reach)); };
  for (int row = square(frame.bottom - reach); row <= square(frame.bottom + frame.size() + reach); ++row)
    for (int column = square(frame.left - reach); column <= square(frame.left + frame.size() + reach);
         ++column) {
      Draw draw(seed, kind, column, row);
      const int count = static_cast<int>(density * reach * reach + draw());
      for (int i = 0; i < count; ++i) {
        const Place start{(column + draw()) * reach, (row + draw()) * reach};
        grow(draw, start);
      }
    }
}

// A thread thinner than a cell darkens the cell by its share of it.
struct Thread {
  double half;
  double share;
};
Thread thread(double width, double cell) {
  const double half = std::max(0.5 * width, 0.75 * cell);
  return {half, std::min(1.0, 0.5 * width / half * 1.5)};
}

double fading(double t) { return t * t * (3 - 2 * t); }

// Value noise: smooth between random values a `size` apart.
double noise(std::uint64_t seed, Kind kind, double size, Place p) {
  const double x = p.x / size;
  const double y = p.y / size;
  const int column = static_cast<int>(std::floor(x));
  const int row = static_cast<int>(std::floor(y));
  const auto value = [&](int dx, int dy) { return Draw(seed, kind, column + dx, row + dy)(); };
  const double u = fading(x - column);
  const double v = fading(y - row);
  const double low = value(0, 0) + u * (value(1, 0) - value(0, 0));
  const double high = value(0, 1) + u * (value(1, 1) - value(0, 1));
  return low + v * (high - low);
}

}  // namespace

PaperTexture::PaperTexture(const PaperSpec& paper, std::uint64_t seed, double cell_mm, int columns, int rows,
                           bool flow)
    : paper_(paper), seed_(seed), cell_mm_(cell_mm), columns_(columns), rows_(rows), flow_(flow) {}

void PaperTexture::sample(int left, int bottom, Texture* cells) const {
  const Frame frame{left * cell_mm_, bottom * cell_mm_, cell_mm_};
  std::array<double, tile::cells> fibres{};
  std::array<double, tile::cells> pins{};
  std::array<double, tile::cells> alum{};

  const Thread fibre = thread(paper_.fibre_width, cell_mm_);
  for_each_seed(
      frame, seed_, Kind::fibre, paper_.fibre_density, 1.5 * paper_.fibre_length + fibre.half,
      [&](Draw& draw, Place at) {
        // Four pieces, each turned a little against the last: a gentle curve.
        constexpr int pieces = 4;
        const double length = paper_.fibre_length * (0.5 + draw()) / pieces;
        const double strength = fibre.share * (0.4 + 0.6 * draw());
        const elementary::SineCosine heading = elementary::sine_cosine(2 * std::numbers::pi * draw());
        const elementary::SineCosine turn = elementary::sine_cosine(0.7 * (draw() - 0.5));
        double dx = length * heading.cosine;
        double dy = length * heading.sine;
        for (int i = 0; i < pieces; ++i) {
          const Place next{at.x + dx, at.y + dy};
          stroke_segment(frame, at, next, fibre.half,
                         [&](std::size_t cell, double profile) { fibres[cell] += strength * profile; });
          const double turned = dx * turn.cosine - dy * turn.sine;
          dy = dx * turn.sine + dy * turn.cosine;
          dx = turned;
          at = next;
        }
      });

  const Thread pin = thread(paper_.pin_width, cell_mm_);
  for_each_seed(frame, seed_, Kind::pin, paper_.pin_density, 1.5 * paper_.pin_length + pin.half,
                [&](Draw& draw, Place at) {
                  const double length = paper_.pin_length * (0.5 + draw());
                  const elementary::SineCosine heading =
                      elementary::sine_cosine(2 * std::numbers::pi * draw());
                  const Place end{at.x + length * heading.cosine, at.y + length * heading.sine};
                  stroke_segment(frame, at, end, pin.half, [&](std::size_t cell, double profile) {
                    pins[cell] = std::max(pins[cell], pin.share * profile);
                  });
                });

  const double dot = 0.5 * std::max(paper_.alum_size, cell_mm_);
  for_each_seed(frame, seed_, Kind::alum, paper_.alum_density, 2 * dot, [&](Draw&, Place at) {
    stroke_segment(frame, at, at, dot,
                   [&](std::size_t cell, double profile) { alum[cell] = std::max(alum[cell], profile); });
  });

  for (std::size_t i = 0; i < fibres.size(); ++i) {
    const Place p{frame.left + (static_cast<double>(i % tile::side) + 0.5) * cell_mm_,
                  frame.bottom + (static_cast<double>(i / tile::side) + 0.5) * cell_mm_};
    const double cloud = 0.65 * noise(seed_, Kind::cloud, paper_.cloud_size, p) +
                         0.35 * noise(seed_, Kind::fine_cloud, 0.3 * paper_.cloud_size, p);
    const double felt = fibres[i] / (0.6 + fibres[i]);
    cells[i] = {static_cast<float>(felt + paper_.cloud_share * (cloud - felt)), static_cast<float>(pins[i]),
                static_cast<float>(alum[i])};
  }
}

void PaperTexture::fill(int left, int bottom, const PlaneView& view) const {
  std::array<Texture, tile::cells> textures;
  sample(left, bottom, textures.data());
  for (int y = 0; y < tile::side; ++y) {
    float* blocking = view.cells(tile::paper_begin + tile::blocking, y);
    float* grain = view.cells(tile::paper_begin + tile::grain, y);
    float* toe = view.cells(tile::paper_begin + tile::toe, y);
    for (int x = 0; x < tile::side; ++x) {
      const Texture& t = textures[static_cast<std::size_t>(y * tile::side + x)];
      const bool on_sheet = left + x < columns_ && bottom + y < rows_;
      const double free = paper_.block_base + paper_.block_grain * static_cast<double>(t.grain) +
                          paper_.block_alum * static_cast<double>(t.alum);
      const float paper = flow_ ? static_cast<float>(std::min(free, 1.0)) : 1.0F;
      blocking[x] = on_sheet ? paper : tile::closed_blocking;
      grain[x] = on_sheet ? static_cast<float>(paper_.pin_texture) * t.grain : tile::closed_grain;
      toe[x] = on_sheet ? static_cast<float>(paper_.pin_texture) * (t.pins - t.grain) : 0.0F;
    }
  }
}

}  // namespace fude
