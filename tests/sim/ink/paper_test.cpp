#include "sim/ink/paper.h"

#include <gtest/gtest.h>

#include <set>

#include "sim/ink/lattice_numbers.h"

namespace fude {
namespace {

TEST(Paper, EveryRowOfTheTableHoldsItsOwnDefault) {
  std::set<std::string_view> ids;
  for (const PaperParameter& row : paper_parameters()) {
    EXPECT_TRUE(ids.insert(row.id).second) << row.id;
    EXPECT_LE(row.low, row.standard) << row.id;
    EXPECT_LE(row.standard, row.high) << row.id;
    EXPECT_EQ(PaperSpec{}.*(row.value), row.standard) << row.id;
    EXPECT_FALSE(row.meaning.empty());
  }
}

TEST(Paper, ReadsItsOwnTableAndLeavesOthersAlone) {
  const auto paper =
      read_paper("name = \"card\"\n[ink]\ncapacity = 0.2\n[optics]\nwhite = 0.9\n", "card.toml");
  ASSERT_TRUE(paper.has_value());
  EXPECT_EQ(paper->name, "card");
  EXPECT_EQ(paper->capacity, 0.2);
  EXPECT_EQ(paper->film, PaperSpec{}.film);
}

TEST(Paper, SaysWhatIsWrong) {
  const auto message = [](std::string_view toml) { return read_paper(toml, "p.toml").error().message; };
  EXPECT_EQ(message("[ink]\ncapacity = 7.0\n"), "p.toml: capacity must be a number from 0.005 to 2 µl/mm²");
  EXPECT_EQ(message("[ink]\ncapacity = \"much\"\n"),
            "p.toml: capacity must be a number from 0.005 to 2 µl/mm²");
  EXPECT_EQ(message("[ink]\ncapacity = nan\n"), "p.toml: capacity must be a number from 0.005 to 2 µl/mm²");
  EXPECT_EQ(message("[ink]\nthirst = 1\n"), "p.toml: no ink parameter is called 'thirst'");
  EXPECT_NE(message("[ink\n").find("p.toml, line 1"), std::string::npos);
  EXPECT_EQ(load_paper("/nowhere/x.toml").error().fault, Fault::not_found);
}

TEST(LatticeNumbers, FollowFromSiUnits) {
  PaperSpec paper;
  paper.viscosity = 0.6;
  paper.evaporation = 0.0012;
  paper.capacity = 0.06;
  const LatticeNumbers coarse = lattice_numbers(paper, 0.1);
  EXPECT_DOUBLE_EQ(step_seconds(0.1), 1.0 / 120);
  // nu = 0.6 mm²/s · dt/dx² = 0.5, so omega = 1/(3·0.5 + 0.5).
  EXPECT_NEAR(coarse.relaxation, 0.5F, 1e-6F);
  EXPECT_NEAR(coarse.evaporation, 0.0012 / 120 / 0.06, 1e-9);
  const LatticeNumbers fine = lattice_numbers(paper, 0.05);
  EXPECT_DOUBLE_EQ(step_seconds(0.05), 1.0 / 480);
  EXPECT_EQ(fine.relaxation, coarse.relaxation);
  EXPECT_NEAR(fine.evaporation, coarse.evaporation / 4, 1e-10);
  EXPECT_NEAR(fine.edge_evaporation, coarse.edge_evaporation / 2, 1e-10);
}

}  // namespace
}  // namespace fude
