// The tuft's surface: elliptic sections swept along the spine (Chu 2.4.2), and where it meets the
// paper. Paper frame, mm.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "signal/pose.h"
#include "sim/brush/program.h"
#include "sim/brush/skeleton.h"
#include "sim/brush/tuft.h"

namespace fude {

// One section: two half-ellipses with half axes major_a (where `lateral` points) and major_b along the
// lateral line, and `minor` along `down`, the direction in the section's plane that looks to the paper.
struct Station {
  double along = 0;  // 0 root to 1 tip
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Vector3d lateral = Eigen::Vector3d::UnitX();
  Eigen::Vector3d down = Eigen::Vector3d::UnitY();
  double major_a = 0;
  double major_b = 0;
  double minor = 0;
  double press_mn_mm = 0;  // of the paper against it, along the tuft
  bool squared = false;    // x = a sgn(cos t) √|cos t|, of a slice of a flat brush (Chu 2.8, put right)
  bool flipped = false;    // `down` is the far side of the hair: the texture runs the other way round
};

using TuftSurface = std::vector<Station>;  // root to tip; as many for every state of one tuft

TuftSurface surface_of(const Tuft& tuft, const Variables& x, const Pose<Paper, Handle>& paper_from_handle);

// Sets the pressure at every station from that at the nodes, mN (of nodes 1 to n).
void press(const Tuft& tuft, const Multipliers& reactions_mn, TuftSurface& surface);

// The surface with the ink that clings to it: every section swollen by `by_mm` (Chu 2.7.2).
TuftSurface swollen(TuftSurface surface, double by_mm);

// Part of the way from a to b, t in [0, 1].
TuftSurface between(const TuftSurface& a, const TuftSurface& b, double t);

// The largest distance by which a station moves over the paper, mm.
double largest_motion_mm(const TuftSurface& a, const TuftSurface& b);

// What the hair of a section feels.
struct HairState {
  double press_mn_mm = 0;
  double spread = 0;  // how much wider the section is than round, 0 to …
};

// Points where one section dips into the paper, from side to side, seen from above.
inline constexpr int ring_points = 5;
struct ContactRing {
  int place = 0;  // grows from root to tip; equal for the same part of the tuft in another state of it
  double along = 0;
  std::array<Eigen::Vector2d, ring_points> point;  // mm
  std::array<double, ring_points> around{};        // turns about the spine from the lateral line
  HairState hair;
};

// What of the surface is in the paper: runs of rings, each run one patch of wetted paper.
struct Contact {
  std::vector<ContactRing> rings;
  std::vector<std::size_t> run_ends;  // one beyond the last ring of each run
  std::span<const ContactRing> run(std::size_t i) const {
    const std::size_t first = i == 0 ? 0 : run_ends[i - 1];
    return std::span(rings).subspan(first, run_ends[i] - first);
  }
};

// The paper cuts the surface at z = 0; the shrunk section keeps it from cutting deeper. Takes the place
// of what was in `contact`, in its memory.
void contact_of(const TuftSurface& surface, Contact& contact);

}  // namespace fude
