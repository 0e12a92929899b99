#include "sim/brush/contact_mesh.h"

namespace fude {

using Eigen::Vector2d;

namespace {

constexpr std::size_t last_point = ring_points - 1;

// Which way the two triangles of each quad between two rings turn; 0 where there is no quad.
struct Strip {
  std::array<int, last_point> near{};  // (ring, j), (ring, j + 1), (next, j + 1)
  std::array<int, last_point> far{};   // (ring, j), (next, j + 1), (next, j)
};

Strip strip_between(const ContactRing& ring, const ContactRing& next) {
  Strip strip;
  for (std::size_t j = 0; j < last_point; ++j) {
    strip.near[j] = turn_of(ring.point[j], ring.point[j + 1], next.point[j + 1]);
    strip.far[j] = turn_of(ring.point[j], next.point[j + 1], next.point[j]);
  }
  return strip;
}

std::array<int, 3 * ring_points - 2> rim_weights(const Strip& last, const Strip& next) {
  std::array<int, 3 * ring_points - 2> weights{};
  std::size_t i = 0;
  for (std::size_t j = 0; j < last_point; ++j) weights[i++] = next.near[j] - last.far[j];
  for (std::size_t j = 0; j < ring_points; ++j)
    weights[i++] = (j > 0 ? next.near[j - 1] : 0) - (j < last_point ? next.far[j] : 0);
  for (std::size_t j = 0; j < last_point; ++j) weights[i++] = next.far[j] - next.near[j];
  return weights;
}

}  // namespace

void ContactMesh::take(const TuftSurface& surface) {
  contact_of(surface, contact_);
  joined_.clear();
  rim_.clear();
  for (std::size_t r = 0; r < contact_.run_ends.size(); ++r) {
    const auto run = contact_.run(r);
    Strip last;
    for (std::size_t i = 0; i < run.size(); ++i) {
      joined_.push_back(i + 1 < run.size());
      const Strip next = joined_.back() ? strip_between(run[i], run[i + 1]) : Strip{};
      rim_.push_back(rim_weights(last, next));
      last = next;
    }
  }
}

void ContactMesh::add_to(WindingFill& filling) const {
  for (std::size_t i = 0; i < rim_.size(); ++i)
    for (std::size_t k = 0; k < edges_per_ring; ++k)
      if (rim_[i][k] != 0) filling.add_edge(head(i, edges[k]).at, tail(i, edges[k]).at, rim_[i][k]);
}

}  // namespace fude
