#include "sim/ink/lattice_numbers.h"

#include <algorithm>

namespace fude {
namespace {

// A smoothstep whose edges coincide is a step.
double per(double edge) { return edge > 1e-30 ? 1 / edge : 1e30; }

// omega from the viscosity in lattice units, nu = (1/omega - 1/2)/3.
double relaxation(double viscosity) { return std::min(1 / (3 * viscosity + 0.5), 1.99); }

}  // namespace

double step_seconds(double cell_mm) { return cell_mm * cell_mm / 1.2; }

LatticeNumbers lattice_numbers(const PaperSpec& paper, double cell_mm) {
  const double dt = step_seconds(cell_mm);
  const double speed = dt / cell_mm;       // mm/s to cells a step
  const double area = 1 / paper.capacity;  // µl/mm² to saturations
  // A link of weight w in water of speed u carries 6 w u, where nothing blocks it.
  const double pace = per(6 * paper.hindrance_speed * speed);
  const auto narrow = [](double x) { return static_cast<float>(x); };
  return {
      .relaxation = narrow(relaxation(paper.viscosity * dt / (cell_mm * cell_mm))),
      .per_advection = narrow(per(paper.advection)),
      .block_glue = narrow(paper.block_glue),
      .block_fixed = narrow(paper.block_fixed),
      .pin_base = narrow(paper.pin_base),
      .pin_fixed = narrow(paper.pin_fixed),
      .per_toe_glue = narrow(per(paper.toe_glue)),
      .evaporation = narrow(paper.evaporation * dt * area),
      .edge_evaporation = narrow(paper.edge_evaporation * dt * area / cell_mm),
      .carried = narrow(1 - paper.hindrance),
      .pace_straight = narrow(std::min(9 * pace, 1e30)),
      .pace_diagonal = narrow(std::min(36 * pace, 1e30)),
      .fix_base = narrow(std::min(paper.fix_base * dt, 1.0)),
      .fix_dryness = narrow(paper.fix_dryness),
      .fix_glue = narrow(paper.fix_glue),
      .per_receptivity = narrow(per(paper.receptivity)),
      .receptivity_floor = narrow(paper.receptivity_floor),
      .film = narrow(paper.film * area),
      .standing = narrow(paper.standing * area),
      .exchange = narrow(paper.exchange),
  };
}

}  // namespace fude
