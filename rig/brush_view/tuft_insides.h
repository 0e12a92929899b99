// What the solver knows of the tufts beside their shape, for the development view.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "sim/brush/brush.h"

namespace fude {

struct TuftInsides {
  // Where a node that touches the paper stands, and the place from which its friction pulls. Paper
  // millimetres.
  struct Contact {
    Eigen::Vector3d node;
    Eigen::Vector2d anchor;
  };
  std::vector<Contact> contacts;
  // The blocking plane, where one stands: the line in which it meets the paper, as far as it is drawn.
  std::vector<std::array<Eigen::Vector2d, 2>> planes;
};

TuftInsides insides_of(const Brush& brush);

}  // namespace fude
