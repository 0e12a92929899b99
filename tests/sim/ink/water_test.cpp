// The lattice alone (stream, block, collide) against analytic flow, on a sheet of one row of tiles that
// closes upon itself both ways.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "sim/compute/arena.h"
#include "sim/compute/instruction_set.h"
#include "sim/ink/lattice_numbers.h"
#include "sim/ink/tile_step.h"

namespace fude {
namespace {

constexpr std::array<double, 9> weight{4. / 9,  1. / 9,  1. / 9,  1. / 9, 1. / 9,
                                       1. / 36, 1. / 36, 1. / 36, 1. / 36};
constexpr std::array<int, 9> ex{0, 1, 0, -1, 0, 1, -1, -1, 1};
constexpr std::array<int, 9> ey{0, 0, 1, 0, -1, 1, 1, -1, -1};

struct Flow {
  double water, ux, uy;
};

class PeriodicSheet {
 public:
  PeriodicSheet(int tiles, double relaxation, double blocking) : tiles_(tiles) {
    PaperSpec paper;
    numbers_ = lattice_numbers(paper, 0.1);
    numbers_.relaxation = static_cast<float>(relaxation);
    for (int t = 0; t < tiles; ++t) {
      blocks_.push_back(arena_.take());
      for (int y = 0; y < tile::side; ++y)
        std::fill_n(cells(t, tile::paper_begin + tile::blocking, y), tile::side,
                    static_cast<float>(blocking));
    }
  }

  int width() const { return tiles_ * tile::side; }

  // Equilibrium populations of He and Luo.
  void fill(const std::function<Flow(int x, int y)>& flow) {
    for (int y = 0; y < tile::side; ++y)
      for (int x = 0; x < width(); ++x) {
        const Flow f = flow(x, y);
        for (std::size_t i = 0; i < 9; ++i) {
          const double eu = ex[i] * f.ux + ey[i] * f.uy;
          at(i, x, y) = static_cast<float>(
              weight[i] * (f.water + 3 * eu + 4.5 * eu * eu - 1.5 * (f.ux * f.ux + f.uy * f.uy)));
        }
      }
  }

  void step(int steps) {
    const StepKernels& kernels = step_kernels(widest_instruction_set());
    for (int t = 0; t < tiles_; ++t) kernels.water.edges(numbers_, block(t), parity_);
    for (int s = 0; s < steps; ++s) {
      for (int t = 0; t < tiles_; ++t) {
        Neighbourhood blocks{};
        for (int i = 0; i < 9; ++i)
          blocks[static_cast<std::size_t>(i)] = block((t + i % 3 - 1 + tiles_) % tiles_);
        TileOutcome outcome;
        kernels.water.tile(numbers_, blocks, blocks, parity_, outcome);
      }
      parity_ = 1 - parity_;
    }
  }

  float& at(std::size_t i, int x, int y) {
    return cells(x / tile::side, i, y)[x % tile::side];
  }

  Flow flow(int x, int y) {
    Flow sum{0, 0, 0};
    for (std::size_t i = 0; i < 9; ++i) {
      const double f = at(i, x, y);
      sum.water += f;
      sum.ux += f * ex[i];
      sum.uy += f * ey[i];
    }
    return sum;
  }

  double total() {
    double sum = 0;
    for (int y = 0; y < tile::side; ++y)
      for (int x = 0; x < width(); ++x) sum += flow(x, y).water;
    return sum;
  }

  float lowest() {
    float least = 1;
    for (std::size_t i = 0; i < 9; ++i)
      for (int y = 0; y < tile::side; ++y)
        for (int x = 0; x < width(); ++x) least = std::min(least, at(i, x, y));
    return least;
  }

 private:
  float* cells(int t, std::size_t plane, int y) { return arena_view(block(t)).cells(plane, y); }
  float* block(int t) { return blocks_[static_cast<std::size_t>(t)]; }

  int tiles_;
  int parity_ = 0;
  LatticeNumbers numbers_;
  Arena arena_{tile::block_floats, tile::chunk_tiles};
  std::vector<float*> blocks_;
};

// Amplitude of cos(2 pi x / width) in a row.
template <class Value>
double amplitude(int width, const Value& value) {
  double sum = 0;
  for (int x = 0; x < width; ++x) sum += value(x) * std::cos(2 * std::numbers::pi * x / width);
  return 2 * sum / width;
}

TEST(Water, AShearWaveDecaysWithTheViscosity) {
  for (double omega : {0.5, 1.0, 1.5}) {
    PeriodicSheet sheet(2, omega, 0);
    const double k = 2 * std::numbers::pi / sheet.width();
    sheet.fill([&](int x, int) { return Flow{1, 0, 0.01 * std::cos(k * x)}; });
    const int steps = 100;
    sheet.step(steps);
    const double left = amplitude(sheet.width(), [&](int x) { return sheet.flow(x, 5).uy; });
    const double viscosity = (1 / omega - 0.5) / 3;
    EXPECT_NEAR(std::log(0.01 / left) / (steps * k * k), viscosity, 0.03 * viscosity) << omega;
  }
}

// Darcy: the water that crosses a blocked link is K/nu times the pressure gradient, K = nu (1 - kappa)/(2
// kappa). With p = rho/3 a density wave then spreads by diffusion with D = (1 - kappa)/(6 kappa).
TEST(Water, ABlockedLatticeHasTheDarcyPermeability) {
  for (double kappa : {0.5, 0.7, 0.9}) {
    for (double omega : {0.5, 1.2}) {
      PeriodicSheet sheet(2, omega, kappa);
      const double k = 2 * std::numbers::pi / sheet.width();
      sheet.fill([&](int x, int) { return Flow{1 + 0.01 * std::cos(k * x), 0, 0}; });
      const auto wave = [&] {
        return amplitude(sheet.width(), [&](int x) { return sheet.flow(x, 3).water; });
      };
      sheet.step(50);  // past the start, when no water flows yet
      const double before = wave();
      const int steps = 400;
      sheet.step(steps);
      const double want = (1 - kappa) / (6 * kappa);
      EXPECT_NEAR(std::log(before / wave()) / (steps * k * k), want, 0.03 * want) << kappa << " " << omega;
    }
  }
}

TEST(Water, NoPopulationBecomesNegativeAndNoWaterIsLost) {
  for (double omega : {0.5, 1.0, 1.5, 1.9, 1.99}) {
    for (double kappa : {0.0, 0.4}) {
      PeriodicSheet sheet(2, omega, kappa);
      sheet.fill([](int x, int y) { return Flow{(x / 8 + y / 8) % 2 == 0 ? 1.0 : 0.001, 0, 0}; });
      const double before = sheet.total();
      float lowest = 0;
      for (int i = 0; i < 100; ++i) {
        sheet.step(20);
        lowest = std::min(lowest, sheet.lowest());
      }
      EXPECT_GE(lowest, -2e-8F) << omega << " " << kappa;
      EXPECT_NEAR(sheet.total(), before, 2e-6 * before) << omega << " " << kappa;
    }
  }
}

}  // namespace
}  // namespace fude
