#include "sim/brush/footprint.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/brush/coverage.h"
#include "sim/brush/loading.h"

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
    inked_.assign(cells, 1);
    for (const InkLoad& load : loads)
      streaky_ = streaky_ || static_cast<double>(load.wetness) < texture.streak_wetness();
  }

  // Fills cells that no later instant has filled.
  void add(const Contact& contact) {
    for (const auto& run : contact.runs)
      for (std::size_t i = 1; i < run.size(); ++i)
        for (std::size_t j = 1; j < ring_points; ++j) add_cell_quad(run[i - 1], run[i], j);
  }

  // Cells that hold a sample but no centre take after a neighbour that has one.
  std::uint16_t patch(int row, int column) const { return patch_[nearest(row, column)]; }
  float inked(int row, int column) const { return inked_[nearest(row, column)]; }

  static constexpr std::uint16_t none = 0xffff;

 private:
  std::size_t at(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(frame_.columns()) +
           static_cast<std::size_t>(column);
  }
  std::size_t nearest(int row, int column) const {
    for (int ring = 0; ring < 4; ++ring)
      for (int dy = -ring; dy <= ring; ++dy)
        for (int dx = -ring; dx <= ring; ++dx) {
          const int y = row + dy;
          const int x = column + dx;
          if (y < 0 || x < 0 || y >= frame_.rows || x >= frame_.columns()) continue;
          if (patch_[at(y, x)] != none) return at(y, x);
        }
    return at(row, column);
  }
  void add_cell_quad(const ContactRing& a, const ContactRing& b, std::size_t j);

  const CoverageFrame& frame_;
  const HairTexture& texture_;
  const std::vector<InkLoad>& loads_;
  std::vector<std::uint16_t> patch_;
  std::vector<float> inked_;
  bool streaky_ = false;
};

// Narrows [from, to] to where value + slope x ≥ 0.
void clip(double value, double slope, double& from, double& to) {
  if (slope > 0) {
    from = std::max(from, -value / slope);
  } else if (slope < 0) {
    to = std::min(to, -value / slope);
  } else if (value < 0) {
    to = from;
  }
}

// Within a quad the place on the tuft goes over linearly: bilinear inverse by its two triangles.
void Stamp::add_cell_quad(const ContactRing& a, const ContactRing& b, std::size_t j) {
  struct Corner {
    Vector2d p;
    double along;
    double around;
  };
  const std::array<Corner, 4> corner = {{{a.point[j - 1], a.along, a.around[j - 1]},
                                         {a.point[j], a.along, a.around[j]},
                                         {b.point[j], b.along, b.around[j]},
                                         {b.point[j - 1], b.along, b.around[j - 1]}}};
  const Vector2d origin(frame_.left_mm(), frame_.bottom_mm());
  for (const std::array<std::size_t, 3>& t : {std::array<std::size_t, 3>{0, 1, 2}, {0, 2, 3}}) {
    const Vector2d p = (corner[t[0]].p - origin) / frame_.cell_mm;
    const Vector2d u = (corner[t[1]].p - corner[t[0]].p) / frame_.cell_mm;
    const Vector2d v = (corner[t[2]].p - corner[t[0]].p) / frame_.cell_mm;
    const double area = u.x() * v.y() - u.y() * v.x();
    if (std::abs(area) < 1e-12) continue;
    const double along_s = corner[t[1]].along - corner[t[0]].along;
    const double along_r = corner[t[2]].along - corner[t[0]].along;
    const double around_s = corner[t[1]].around - corner[t[0]].around;
    const double around_r = corner[t[2]].around - corner[t[0]].around;
    // Cell centres in a row lie in the triangle where s, r and 1 − s − r are all positive; each is a
    // straight line along the row.
    const int row_end =
        std::min(frame_.rows - 1, static_cast<int>(std::max({p.y(), p.y() + u.y(), p.y() + v.y()})));
    const double s_by_x = v.y() / area;
    const double r_by_x = -u.y() / area;
    for (int row = std::max(0, static_cast<int>(std::min({p.y(), p.y() + u.y(), p.y() + v.y()})));
         row <= row_end; ++row) {
      const double dy = row + 0.5 - p.y();
      const double s0 = (-p.x() * v.y() - dy * v.x()) / area;
      const double r0 = (dy * u.x() + p.x() * u.y()) / area;
      double from = 0;
      double to = frame_.columns();
      clip(s0, s_by_x, from, to);
      clip(r0, r_by_x, from, to);
      clip(1 - s0 - r0, -s_by_x - r_by_x, from, to);
      if (!(from < to)) continue;
      const int last = to < 0.5 ? -1 : static_cast<int>(to - 0.5);
      const double along_by_x = s_by_x * along_s + r_by_x * along_r;
      const double around_by_x = s_by_x * around_s + r_by_x * around_r;
      const double along_0 = corner[t[0]].along + s0 * along_s + r0 * along_r;
      const double around_0 = corner[t[0]].around + s0 * around_s + r0 * around_r;
      for (int column = static_cast<int>(from + 0.5); column <= last; ++column) {
        const std::size_t cell = at(row, column);
        if (patch_[cell] != none) continue;
        const double along = along_0 + along_by_x * (column + 0.5);
        const double around = around_0 + around_by_x * (column + 0.5);
        const int patch = patch_at(along, around);
        patch_[cell] = static_cast<std::uint16_t>(patch);
        if (streaky_)
          inked_[cell] = static_cast<float>(texture_.inked(
              along, around, static_cast<double>(loads_[static_cast<std::size_t>(patch)].wetness)));
      }
    }
  }
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
        const std::uint16_t patch = stamp.patch(row, column);
        map.patch[cell] = patch == Stamp::none ? std::uint16_t{0} : patch;
        const float inked = stamp.inked(row, column);
        map.fresh[cell] = inked * static_cast<float>(counts[c]) / (samples_per_side * samples_per_side);
        map.contact_s[cell] *= inked;
      }
    }
  }
  return map;
}

}  // namespace fude
