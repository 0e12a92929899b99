#include "sim/brush/contact_mesh.h"

namespace fude {

using Eigen::Vector2d;

namespace {

constexpr std::size_t last_point = ring_points - 1;

struct MeshEdge {
  std::size_t from;  // point of this ring
  bool onward;       // to a point of the next
  std::size_t to;
};
constexpr auto mesh_edges = [] {
  std::array<MeshEdge, 3 * ring_points - 2> edges{};
  std::size_t i = 0;
  for (std::size_t j = 0; j < last_point; ++j) edges[i++] = {j, false, j + 1};
  for (std::size_t j = 0; j < ring_points; ++j) edges[i++] = {j, true, j};
  for (std::size_t j = 0; j < last_point; ++j) edges[i++] = {j, true, j + 1};
  return edges;
}();

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

std::array<int, mesh_edges.size()> rim_weights(const Strip& last, const Strip& next) {
  std::array<int, mesh_edges.size()> weights{};
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

const Vector2d& ContactMesh::head(std::size_t ring, std::size_t edge) const {
  return contact_.rings[ring].point[mesh_edges[edge].from];
}

const Vector2d& ContactMesh::tail(std::size_t ring, std::size_t edge) const {
  return contact_.rings[ring + (mesh_edges[edge].onward ? 1 : 0)].point[mesh_edges[edge].to];
}

void ContactMesh::add_to(WindingFill& filling) const {
  for (std::size_t i = 0; i < rim_.size(); ++i)
    for (std::size_t edge = 0; edge < edges_per_ring; ++edge)
      if (rim_[i][edge] != 0) filling.add_edge(head(i, edge), tail(i, edge), rim_[i][edge]);
}

void add_passage(WindingFill& filling, const ContactMesh& a, const ContactMesh& b) {
  const auto& before = a.contact_.rings;
  const auto& after = b.contact_.rings;
  bool goes_on = false;
  for (std::size_t i = 0, j = 0; i < before.size() && j < after.size();) {
    if (before[i].place != after[j].place) {
      before[i].place < after[j].place ? ++i : ++j;
      goes_on = false;
      continue;
    }
    const bool begins = !goes_on;
    goes_on = a.joined_[i] && b.joined_[j] && before[i + 1].place == after[j + 1].place;
    for (std::size_t edge = 0; edge < mesh_edges.size(); ++edge) {
      if (mesh_edges[edge].onward && !goes_on) break;
      // Where the shared part ends its ring passes whole: what lies beyond differs.
      const bool ends = !mesh_edges[edge].onward && (begins || !goes_on);
      if (!ends && a.rim_[i][edge] == 0 && b.rim_[j][edge] == 0) continue;
      filling.add_quad(a.head(i, edge), a.tail(i, edge), b.tail(j, edge), b.head(j, edge));
    }
    ++i;
    ++j;
  }
}

}  // namespace fude
