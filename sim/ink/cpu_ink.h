// The ink on the processor: the reference for every other back-end.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "sim/ink/ink.h"
#include "sim/ink/lattice.h"

namespace fude {

class CpuInk final : public Ink {
 public:
  // The setup must be in range; set is what the processor has.
  CpuInk(const InkSetup& setup, InstructionSet set);

  int columns() const override { return columns_; }
  int rows() const override { return rows_; }
  double cell_mm() const override { return setup_.cell_mm; }
  double step_s() const override { return step_seconds(setup_.cell_mm); }
  void apply(const InkEvent& event) override;
  void step() override;
  std::vector<Exchange> collect() override;
  InkTotals totals() const override;
  std::uint64_t steps() const override { return steps_; }
  std::size_t active_cells() const override;
  CellRect active_rect() const override;
  bool still() const override;
  InkRegion read(const CellRect& rect) const override;
  InkSnapshot snapshot(InkSnapshot memory) const override;
  void restore(const InkSnapshot& snapshot) override;
  std::uint64_t hash() const override;

 private:
  Exchange deposit(const Deposit& deposit);
  void dry_sheet();
  double ul_in_cell() const;  // water that saturates a cell

  InkSetup setup_;
  int columns_;
  int rows_;
  LatticeNumbers numbers_;
  mutable ThreadPool threads_;
  std::unique_ptr<Lattice> lattice_;
  std::uint64_t steps_ = 0;
  double water_deposited_ = 0;  // in saturated cells, as the rest
  double water_evaporated_ = 0;
  InkTotals::Pigments pigment_deposited_{};
  std::vector<Exchange> ready_;
};

}  // namespace fude
