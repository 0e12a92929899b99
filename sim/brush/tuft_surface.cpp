#include "sim/brush/tuft_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "signal/elementary.h"
#include "sim/brush/section.h"
#include "sim/brush/skeleton.h"

namespace fude {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using std::numbers::pi;

constexpr double station_spacing_mm = 0.8;

auto index(int i) { return static_cast<std::size_t>(i); }

int stations_in(const Tuft& tuft, int segment) {
  return std::max(2, static_cast<int>(tuft.length_mm[index(segment)] / station_spacing_mm + 0.5));
}

struct Cubic {
  double p0, p1, m0, m1;
};
Cubic cubic_hermite(double t) {
  const double t2 = t * t;
  const double t3 = t2 * t;
  return {2 * t3 - 3 * t2 + 1, 3 * t2 - 2 * t3, t3 - 2 * t2 + t, t3 - t2};
}

// The point of the section at angle `around`: 0 and π on the lateral line, π/2 at the bottom.
Vector3d section_point(const Station& s, double around) {
  const auto [sine, cosine] = elementary::sine_cosine(around);
  const double across = s.squared ? std::copysign(elementary::square_root(std::abs(cosine)), cosine) : cosine;
  return s.centre + (cosine > 0 ? s.major_a : s.major_b) * across * s.lateral + s.minor * sine * s.down;
}

// Angles between which the section is under the paper: z(α) = z_O − R cos(α − δ) on either half. A squared
// section is cut at the angles of the elliptic one: the same while it lies level.
struct SubmergedArc {
  double from = std::numeric_limits<double>::infinity();
  double to = -std::numeric_limits<double>::infinity();
  double lowest = 0.5 * pi;
  double depth = -std::numeric_limits<double>::infinity();  // mm under the paper; negative: above it
};

void add_half(const Station& s, double major, double first, double last, SubmergedArc& arc) {
  const double level = major * s.lateral.z();
  const double upright = -s.minor * s.down.z();
  const double reach = elementary::square_root(level * level + upright * upright);
  if (reach == 0) return;
  double deepest = elementary::arctangent(upright, -level);
  if (deepest < 0.5 * (first + last) - pi) deepest += 2 * pi;  // the turn nearest to this half
  const double clamped = std::clamp(deepest, first, last);
  const auto [sine, cosine] = elementary::sine_cosine(clamped);
  const double depth = -(s.centre.z() + level * cosine - upright * sine);
  if (depth > arc.depth) {
    arc.depth = depth;
    arc.lowest = clamped;
  }
  const double ratio = s.centre.z() / reach;
  if (ratio >= 1) return;
  const double half = elementary::arccosine(std::max(ratio, -1.0));
  const double from = std::max(first, deepest - half);
  const double to = std::min(last, deepest + half);
  if (from >= to) return;
  arc.from = std::min(arc.from, from);
  arc.to = std::max(arc.to, to);
}

SubmergedArc submerged_arc(const Station& s) {
  SubmergedArc arc;
  add_half(s, s.major_a, -0.5 * pi, 0.5 * pi, arc);
  add_half(s, s.major_b, 0.5 * pi, 1.5 * pi, arc);
  return arc;
}

// A ring's place: its station's own, or up to three before or behind it.
constexpr int places_per_station = 8;

ContactRing ring_of(const Station& s, int station, const SubmergedArc& arc) {
  ContactRing ring;
  ring.place = places_per_station * station;
  ring.along = s.along;
  const double half = 0.5 * (s.major_a + s.major_b);
  ring.hair = {s.press_mn_mm, std::max(0.0, elementary::square_root(half / s.minor) - 1)};
  for (int i = 0; i < ring_points; ++i) {
    const double around = arc.from + (arc.to - arc.from) * i / (ring_points - 1);
    ring.point[index(i)] = section_point(s, around).head<2>();
    const double turns = around / (2 * pi);
    ring.around[index(i)] = s.flipped ? 1 - turns : turns;
  }
  return ring;
}

// The ring drawn together about `target` to `width` of itself.
ContactRing narrowed(const ContactRing& ring, const Vector2d& low, const Vector2d& target, double along,
                     double width) {
  ContactRing narrow = ring;
  narrow.along = along;
  for (Vector2d& p : narrow.point) p = target + width * (p - low);
  // Hair runs straight on: what is narrower shows fewer hairs, not all of them drawn together.
  const double middle = ring.around[ring_points / 2];
  for (double& around : narrow.around) around = middle + width * (around - middle);
  return narrow;
}

struct SubmergedStation {
  const Station* station;
  int index;
  SubmergedArc arc;
};

// Where along the way from a wide ring to a narrower one the rings between them stand.
constexpr std::array<double, 3> narrowing_steps = {0.64, 0.91, 1};

// The first `count` of those rings. The square of the width falls evenly, as the depth does, down to
// `last_width` of the wide ring at `share` of the way.
void append_narrowing(const SubmergedStation& wide, const SubmergedStation& other, double share,
                      double last_width, int count, std::vector<ContactRing>& rings) {
  const ContactRing ring = ring_of(*wide.station, wide.index, wide.arc);
  const Vector2d low = section_point(*wide.station, wide.arc.lowest).head<2>();
  const Vector2d far = section_point(*other.station, other.arc.lowest).head<2>();
  const bool opening = other.index < wide.index;
  for (int i = 0; i < count; ++i) {
    const int step = opening ? count - 1 - i : i;
    const double t = narrowing_steps[index(step)];
    const double width = elementary::square_root(1 - t * (1 - last_width * last_width));
    rings.push_back(narrowed(ring, low, low + share * t * (far - low),
                             wide.station->along + share * t * (other.station->along - wide.station->along),
                             width));
    rings.back().place += opening ? -1 - step : 1 + step;
  }
}

// Where the surface leaves the paper between two stations.
void append_ending(const SubmergedStation& wet, SubmergedStation dry, std::vector<ContactRing>& rings) {
  dry.arc = submerged_arc(*dry.station);
  append_narrowing(wet, dry, wet.arc.depth / (wet.arc.depth - dry.arc.depth), 0, 3, rings);
}

double width(const SubmergedStation& s) {
  return (section_point(*s.station, s.arc.to) - section_point(*s.station, s.arc.from)).head<2>().norm();
}

// Between two stations of which one hardly dips in, so that it passes into an ending when it leaves the
// paper. (Arcs are compared, not widths: towards the tip all grows narrow.)
void append_between(const SubmergedStation& a, const SubmergedStation& b, std::vector<ContactRing>& rings) {
  constexpr double alike = 0.7;
  const double arc_a = a.arc.to - a.arc.from;
  const double arc_b = b.arc.to - b.arc.from;
  const auto narrow = [&](const SubmergedStation& wide, const SubmergedStation& other) {
    const double share = std::min(1.0, width(other) / width(wide));
    append_narrowing(wide, other, 1, share, 2, rings);
  };
  if (arc_b < alike * arc_a) narrow(a, b);
  if (arc_a < alike * arc_b) narrow(b, a);
}

// A steep tip touches with its point alone, or a slice with its edge, which no section's plane shows.
void append_tip(const Station& tip, int station, Contact& contact) {
  const double r = tip.minor;
  const double height = tip.centre.z();
  if (height >= r) return;
  const double radius = elementary::square_root(r * r - height * height * (height > 0 ? 1 : 0));
  Vector2d across(1, 0);
  if (tip.squared) across = tip.lateral.head<2>();
  const Vector2d through(-across.y(), across.x());
  for (int i = -2; i <= 2; ++i) {
    const double y = radius * i / 2;
    const double round = elementary::square_root(std::max(0.0, radius * radius - y * y));
    ContactRing ring;
    ring.place = places_per_station * (station + 1) + i;
    ring.along = 1;
    ring.hair = {tip.press_mn_mm, 0};
    for (int j = 0; j < ring_points; ++j) {
      const double half = !tip.squared ? round : j > 2 ? tip.major_a : tip.major_b;
      ring.point[index(j)] = tip.centre.head<2>() + half * (j - 2) / 2 * across + y * through;
      ring.around[index(j)] = 0.25;
    }
    contact.rings.push_back(ring);
  }
  contact.run_ends.push_back(contact.rings.size());
}

}  // namespace

TuftSurface surface_of(const Tuft& tuft, const Variables& x, const Pose<Paper, Handle>& paper_from_handle) {
  const Skeleton skeleton = pose_skeleton(tuft, x, paper_from_handle);
  const Layout layout{tuft.segments};
  const int n = tuft.segments;
  const auto stretch = [&](int node, int side) {
    return node > 0 && node < n ? x[layout.stretch(node, side)] : 0.0;
  };
  const auto tangent = [&](int node) -> Vector3d {
    if (node == 0) return skeleton.along[0];
    if (node == n) return skeleton.along[index(n - 1)];
    return (skeleton.along[index(node - 1)] + skeleton.along[index(node)]).normalized();
  };
  TuftSurface surface;
  double head_mm = 0;
  for (int i = 0; i < n; ++i) {
    const double length = tuft.length_mm[index(i)];
    const int count = stations_in(tuft, i);
    const Vector3d m0 = length * tangent(i);
    const Vector3d m1 = length * tangent(i + 1);
    for (int j = 0; j < count + (i + 1 == n ? 1 : 0); ++j) {
      const double t = static_cast<double>(j) / count;
      const Cubic h = cubic_hermite(t);
      Station s;
      s.along = (head_mm + t * length) / tuft.spec.tuft_length_mm;
      s.centre = h.p0 * skeleton.node[index(i)] + h.p1 * skeleton.node[index(i + 1)] + h.m0 * m0 + h.m1 * m1;
      const Vector3d direction = ((1 - t) * m0 + t * m1).normalized();
      s.lateral = (1 - t) * skeleton.lateral[index(i)] + t * skeleton.lateral[index(i + 1)];
      if (i == 0) s.lateral = skeleton.lateral[1];
      s.lateral = (s.lateral - direction * direction.dot(s.lateral)).normalized();
      s.down = direction.cross(s.lateral);
      if (s.down.z() > 0) {
        s.down = -s.down;
        s.flipped = true;
      }
      const double ease = h.p1;
      const Section section = section_of(rest_radius_mm(tuft.spec, s.along),
                                         (1 - ease) * stretch(i, 0) + ease * stretch(i + 1, 0),
                                         (1 - ease) * stretch(i, 1) + ease * stretch(i + 1, 1));
      s.major_a = section.major_a;
      s.major_b = section.major_b;
      s.minor = section.minor;
      // Between nodes the spine may sag; the paper stops Φ there as well.
      const double lowest = tuft.contact_share * reach_below(section, s.lateral.z()).depth;
      if (i > 0) s.centre.z() = std::max(s.centre.z(), lowest);
      surface.push_back(s);
    }
    head_mm += length;
  }
  return surface;
}

// Each node's reaction is spread over the hair between its neighbours, most at the node.
void press(const Tuft& tuft, const Multipliers& reactions_mn, TuftSurface& surface) {
  const int n = tuft.segments;
  PerNode<double> mn_mm{};
  for (int k = 1; k <= n; ++k) {
    const double above = tuft.length_mm[index(k - 1)];
    const double below = k < n ? tuft.length_mm[index(k)] : 0;
    mn_mm[index(k)] = std::max(0.0, reactions_mn[k - 1]) / (0.5 * (above + below));
  }
  double head_mm = 0;
  int segment = 0;
  for (Station& s : surface) {
    const double mm = s.along * tuft.spec.tuft_length_mm;
    while (segment + 1 < n && mm >= head_mm + tuft.length_mm[index(segment)])
      head_mm += tuft.length_mm[index(segment++)];
    const double part = std::clamp((mm - head_mm) / tuft.length_mm[index(segment)], 0.0, 1.0);
    s.press_mn_mm = (1 - part) * mn_mm[index(segment)] + part * mn_mm[index(segment + 1)];
  }
}

TuftSurface swollen(TuftSurface surface, double by_mm) {
  for (Station& s : surface) {
    s.major_a += by_mm;
    s.major_b += by_mm;
    s.minor += by_mm;
  }
  return surface;
}

TuftSurface between(const TuftSurface& a, const TuftSurface& b, double t) {
  TuftSurface mixed = b;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const bool turned_over = a[i].flipped != b[i].flipped;
    mixed[i].centre = (1 - t) * a[i].centre + t * b[i].centre;
    mixed[i].lateral = ((1 - t) * a[i].lateral + t * b[i].lateral).normalized();
    if (!turned_over) mixed[i].down = ((1 - t) * a[i].down + t * b[i].down).normalized();
    mixed[i].major_a = (1 - t) * a[i].major_a + t * b[i].major_a;
    mixed[i].major_b = (1 - t) * a[i].major_b + t * b[i].major_b;
    mixed[i].press_mn_mm = (1 - t) * a[i].press_mn_mm + t * b[i].press_mn_mm;
    mixed[i].minor = (1 - t) * a[i].minor + t * b[i].minor;
  }
  return mixed;
}

double largest_motion_mm(const TuftSurface& a, const TuftSurface& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    largest = std::max(largest, (b[i].centre - a[i].centre).head<2>().norm());
  return largest;
}

void contact_of(const TuftSurface& surface, Contact& contact) {
  contact.rings.clear();
  contact.run_ends.clear();
  const int count = static_cast<int>(surface.size());
  const auto submerged = [&](int i) {
    const Station& s = surface[index(i)];
    const bool near = s.centre.z() < std::max({s.major_a, s.major_b, s.minor});
    return SubmergedStation{&s, i, near ? submerged_arc(s) : SubmergedArc{}};
  };
  const auto dips = [](const SubmergedStation& s) { return s.arc.from < s.arc.to; };
  SubmergedStation before{};
  for (int i = 0; i < count; ++i) {
    const SubmergedStation here = submerged(i);
    if (dips(here)) {
      if (i > 0 && dips(before)) append_between(before, here, contact.rings);
      if (i > 0 && !dips(before)) append_ending(here, before, contact.rings);
      contact.rings.push_back(ring_of(*here.station, i, here.arc));
      if (i + 1 == count) contact.run_ends.push_back(contact.rings.size());
    } else if (i > 0 && dips(before)) {
      append_ending(before, here, contact.rings);
      contact.run_ends.push_back(contact.rings.size());
    }
    before = here;
  }
  if (count > 0) append_tip(surface.back(), count - 1, contact);
}

}  // namespace fude
