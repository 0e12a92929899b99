// Fills what a set of closed outlines encloses: samples about which they wind a number of times other
// than zero. An edge that two neighbouring pieces share cancels, so that a mesh costs no more than its rim.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "sim/brush/coverage.h"

namespace fude {

// 1 where the triangle turns to the left, else −1.
int turn_of(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c);

// Points in mm, inside the frame of the coverage that is filled.
class WindingFill {
 public:
  void start(const CoverageFrame& frame);

  // Counted `weight` times; all edges together must be closed.
  void add_edge(const Eigen::Vector2d& from, const Eigen::Vector2d& to, int weight);

  // The triangles abc and acd, each counted once whichever way it turns.
  void add_quad(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
                const Eigen::Vector2d& d);

  // Adds what is enclosed to `cover`, whose frame is that of the start, and forgets it.
  void fill(Coverage& cover);

 private:
  struct Edge {
    std::int64_t x;          // where it crosses its first row, in 2^-32 samples of the whole plane
    std::int64_t by_row;     // and how much further on it crosses the next
    int first_row, end_row;  // of the frame
    int weight;              // upwards
  };
  struct Crossing {
    int column;
    int weight;
  };
  CoverageFrame frame_;
  double scale_ = 0;
  std::vector<Edge> edges_;
  std::vector<int> begin_;  // of each row's crossings
  std::vector<int> next_;
  std::vector<Crossing> crossings_;
};

}  // namespace fude
