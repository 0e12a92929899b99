#include "sim/brush/footprint.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/brush/coverage.h"
#include "sim/brush/loading.h"
#include "sim/brush/scanline.h"

namespace fude {
namespace {

using Eigen::Vector2d;

constexpr double sweep_step_mm = 0.4;
constexpr int most_steps = 24;

// Contacts on the way, each with the share of time it stands for.
struct Instant {
  Contact contact;
  double duration_s = 0;
  bool ends_step = false;  // the tuft was solved for here
};

std::vector<Instant> instants(const TuftSurface& before, std::span<const TimedSurface> after) {
  std::vector<Instant> all;
  const TuftSurface* last = before.empty() ? nullptr : &before;
  if (last) all.push_back({contact_of(*last), 0, true});
  for (const TimedSurface& timed : after) {
    if (!last) {
      all.push_back({contact_of(timed.surface), 0, true});
      last = &timed.surface;
      continue;
    }
    const double motion = largest_motion_mm(*last, timed.surface);
    const int steps = std::clamp(static_cast<int>(std::ceil(motion / sweep_step_mm)), 1, most_steps);
    const double dt = timed.since_last_s / steps;
    for (int k = 1; k <= steps; ++k) {
      // Trapezoidal rule: an instant stands for half the time on either side.
      all.back().duration_s += 0.5 * dt;
      const bool ends = k == steps;
      all.push_back(
          {contact_of(ends ? timed.surface : between(*last, timed.surface, static_cast<double>(k) / steps)),
           0.5 * dt, ends});
    }
    last = &timed.surface;
  }
  return all;
}

std::optional<CoverageFrame> frame_of(const std::vector<Instant>& all, double cell_mm) {
  Vector2d low = Vector2d::Constant(1e300);
  Vector2d high = -low;
  for (const Instant& instant : all)
    for (const auto& run : instant.contact.runs)
      for (const ContactRing& ring : run)
        for (const Vector2d& p : ring.point) {
          low = low.cwiseMin(p);
          high = high.cwiseMax(p);
        }
  if (low.x() > high.x()) return std::nullopt;
  return frame_around(low, high, cell_mm);
}

void add_quad(Coverage& cover, const Vector2d& a, const Vector2d& b, const Vector2d& c, const Vector2d& d) {
  cover.add_triangle(a, b, c);
  cover.add_triangle(a, c, d);
}

void add_contact(Coverage& cover, const Contact& contact) {
  for (const auto& run : contact.runs)
    for (std::size_t i = 1; i < run.size(); ++i)
      for (std::size_t j = 1; j < ring_points; ++j)
        add_quad(cover, run[i - 1].point[j - 1], run[i - 1].point[j], run[i].point[j], run[i].point[j - 1]);
}

// What the sides and ends of a run pass over between two instants that show the same run.
void add_passage(Coverage& cover, const Contact& from, const Contact& to) {
  if (from.runs.size() != to.runs.size()) return;
  for (std::size_t r = 0; r < from.runs.size(); ++r) {
    const auto& a = from.runs[r];
    const auto& b = to.runs[r];
    // Rings pair by their place along the tuft; a run that grew or shrank pairs where both have rings.
    std::size_t i = 0;
    const std::array<Vector2d, ring_points>* last_a = nullptr;
    const std::array<Vector2d, ring_points>* last_b = nullptr;
    for (std::size_t j = 0; j < b.size(); ++j) {
      while (i < a.size() && a[i].along < b[j].along) ++i;
      if (i == a.size()) break;
      if (a[i].along != b[j].along) continue;
      const auto& pa = a[i].point;
      const auto& pb = b[j].point;
      for (std::size_t p = 1; p < ring_points; ++p) add_quad(cover, pa[p - 1], pa[p], pb[p], pb[p - 1]);
      if (last_a) {
        add_quad(cover, last_a->front(), pa.front(), pb.front(), last_b->front());
        add_quad(cover, last_a->back(), pa.back(), pb.back(), last_b->back());
      }
      last_a = &pa;
      last_b = &pb;
    }
  }
}

// What of the tuft stands over each cell: its patch, and how much of its hair leaves ink.
class Stamp {
 public:
  Stamp(const CoverageFrame& frame, const HairTexture& texture, const std::vector<InkLoad>& loads)
      : frame_(frame), texture_(texture), loads_(loads) {
    const auto cells = static_cast<std::size_t>(frame.columns()) * static_cast<std::size_t>(frame.rows);
    patch_.assign(cells, none);
    for (const InkLoad& load : loads)
      streaky_ = streaky_ || static_cast<double>(load.wetness) < texture.streak_wetness();
    if (streaky_) inked_.assign(cells, 1);
  }

  // Fills cells that no later instant has filled.
  void add(const Contact& contact) {
    for (const auto& run : contact.runs)
      for (std::size_t i = 1; i < run.size(); ++i)
        for (std::size_t j = 1; j < ring_points; ++j) {
          const Corner a = corner(run[i - 1], j - 1);
          const Corner c = corner(run[i], j);
          add_triangle(a, corner(run[i - 1], j), c);
          add_triangle(a, c, corner(run[i], j - 1));
        }
  }

  // Patch and inked share of a cell; one that holds a sample but no centre takes after a neighbour.
  std::uint16_t patch(std::size_t cell) const {
    return patch_[cell] == none ? std::uint16_t{0} : patch_[cell];
  }
  float inked(std::size_t cell) const { return streaky_ ? inked_[cell] : 1; }
  std::size_t nearest(int row, int column) const;

 private:
  static constexpr std::uint16_t none = 0xffff;

  struct Corner {
    Vector2d cell;
    Vector2d on_tuft;  // along, around
  };
  Corner corner(const ContactRing& ring, std::size_t j) const {
    return {(ring.point[j] - Vector2d(frame_.left_mm(), frame_.bottom_mm())) / frame_.cell_mm,
            {ring.along, ring.around[j]}};
  }
  void add_triangle(const Corner& a, const Corner& b, const Corner& c);
  std::size_t at(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(frame_.columns()) +
           static_cast<std::size_t>(column);
  }

  const CoverageFrame& frame_;
  const HairTexture& texture_;
  const std::vector<InkLoad>& loads_;
  std::vector<std::uint16_t> patch_;
  std::vector<float> inked_;  // where streaky
  bool streaky_ = false;
};

// The place on the tuft goes over linearly within a triangle.
void Stamp::add_triangle(const Corner& a, const Corner& b, const Corner& c) {
  const Vector2d u = b.cell - a.cell;
  const Vector2d v = c.cell - a.cell;
  const double area = u.x() * v.y() - u.y() * v.x();
  if (std::abs(area) < 1e-12) return;
  const Vector2d by_u = (b.on_tuft - a.on_tuft) / area;
  const Vector2d by_v = (c.on_tuft - a.on_tuft) / area;
  const Vector2d by_x = v.y() * by_u - u.y() * by_v;
  const Vector2d by_y = u.x() * by_v - v.x() * by_u;
  scan_triangle(a.cell, b.cell, c.cell, frame_.rows, [&](int row, double from, double to) {
    const Vector2d start = a.on_tuft + (row + 0.5 - a.cell.y()) * by_y - a.cell.x() * by_x;
    const int end = first_centre(to, frame_.columns());
    for (int column = first_centre(from, frame_.columns()); column < end; ++column) {
      const std::size_t cell = at(row, column);
      if (patch_[cell] != none) continue;
      const Vector2d place = start + (column + 0.5) * by_x;
      const int patch = patch_at(place[0], place[1]);
      patch_[cell] = static_cast<std::uint16_t>(patch);
      if (!streaky_) continue;
      const double wetness = static_cast<double>(loads_[static_cast<std::size_t>(patch)].wetness);
      inked_[cell] = static_cast<float>(texture_.inked(place[0], place[1], wetness));
    }
  });
}

std::size_t Stamp::nearest(int row, int column) const {
  for (int ring = 0; ring < 4; ++ring)
    for (int y = std::max(0, row - ring); y <= std::min(frame_.rows - 1, row + ring); ++y)
      for (int x = std::max(0, column - ring); x <= std::min(frame_.columns() - 1, column + ring); ++x)
        if (patch_[at(y, x)] != none) return at(y, x);
  return at(row, column);
}

void add_contact_time(const Coverage& cover, double duration_s, std::vector<float>& contact_s) {
  const CoverageFrame& f = cover.frame();
  const auto per_sample = static_cast<float>(duration_s / (samples_per_side * samples_per_side));
  std::uint8_t counts[cells_per_word];
  for (int row = 0; row < f.rows; ++row)
    for (int word = 0; word < f.words; ++word) {
      if (!cover.any(row, word)) continue;
      cover.count_samples(row, word, counts);
      float* cells =
          contact_s.data() + static_cast<std::ptrdiff_t>(row) * f.columns() + word * cells_per_word;
      for (int c = 0; c < cells_per_word; ++c) cells[c] += per_sample * static_cast<float>(counts[c]);
    }
}

}  // namespace

std::optional<FootprintMap> sweep(const TuftSurface& before, std::span<const TimedSurface> after,
                                  double cell_mm, const HairTexture& texture,
                                  const std::vector<InkLoad>& loads) {
  if (after.empty()) return std::nullopt;
  const std::vector<Instant> all = instants(before, after);
  const std::optional<CoverageFrame> frame = frame_of(all, cell_mm);
  if (!frame) return std::nullopt;

  FootprintMap map;
  map.left_mm = frame->left_mm();
  map.bottom_mm = frame->bottom_mm();
  map.cell_mm = cell_mm;
  map.columns = frame->columns();
  map.rows = frame->rows;
  const auto cells = static_cast<std::size_t>(map.columns) * static_cast<std::size_t>(map.rows);
  map.fresh.assign(cells, 0);
  map.contact_s.assign(cells, 0);
  map.patch.assign(cells, 0);

  Coverage fresh(*frame);
  Coverage passed(*frame);   // since the last solved surface
  Coverage settled(*frame);  // by the last solved surface
  Coverage now(*frame);
  for (std::size_t i = 0; i < all.size(); ++i) {
    now.clear();
    add_contact(now, all[i].contact);
    add_contact_time(now, all[i].duration_s, map.contact_s);
    if (i == 0 && !before.empty()) {
      settled = now;
      continue;
    }
    passed.add(now);
    if (i > 0) add_passage(passed, all[i - 1].contact, all[i].contact);
    if (!all[i].ends_step) continue;
    fresh.add_new(passed, settled);
    settled = now;
    passed.clear();
  }

  Stamp stamp(*frame, texture, loads);
  for (std::size_t i = all.size(); i-- > 0;) stamp.add(all[i].contact);
  std::uint8_t counts[cells_per_word];
  for (int row = 0; row < map.rows; ++row) {
    for (int word = 0; word < frame->words; ++word) {
      fresh.count_samples(row, word, counts);
      for (int c = 0; c < cells_per_word; ++c) {
        const int column = word * cells_per_word + c;
        const auto cell = static_cast<std::size_t>(row) * static_cast<std::size_t>(map.columns) +
                          static_cast<std::size_t>(column);
        if (counts[c] == 0 && map.contact_s[cell] == 0) continue;
        const std::size_t like = stamp.nearest(row, column);
        map.patch[cell] = stamp.patch(like);
        const float inked = stamp.inked(like);
        map.fresh[cell] = inked * static_cast<float>(counts[c]) / (samples_per_side * samples_per_side);
        map.contact_s[cell] *= inked;
      }
    }
  }
  return map;
}

}  // namespace fude
