// Whole blots: what a painter could measure with a ruler and a watch.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "tests/sim/ink/strokes.h"

namespace fude {
namespace {

// Area in mm² where the paper is wet or stained.
double marked_mm2(const Ink& ink) {
  const InkRegion region = ink.read({0, 0, ink.columns(), ink.rows()});
  double cells = 0;
  for (std::size_t i = 0; i < region.pigment.size(); ++i)
    if (region.flow_water[i] > 0 || region.pigment[i][0] > 1e-4F) ++cells;
  return cells * ink.cell_mm() * ink.cell_mm();
}

void even_paper(PaperSpec& paper) {
  paper.pin_texture = 0;
  paper.block_grain = 0;
  paper.evaporation = 0;
  paper.edge_evaporation = 0;
  paper.fix_base = 0;
  paper.pin_fixed = 0;
}

TEST(Blot, ADropBelowTheThresholdIsPinnedAndOneAboveItSpreads) {
  const auto spread = [](double film) {
    const auto ink = sheet(16, [&](InkSetup& setup) {
      even_paper(setup.paper);
      setup.paper.pin_base = 0.5;
      setup.paper.film = film * setup.paper.capacity;
    });
    ink->apply(pour_disc({}, 8, 8, 2));
    ink->step();
    const double before = marked_mm2(*ink);
    step(*ink, 1200);
    return marked_mm2(*ink) / before;
  };
  EXPECT_EQ(spread(0.45), 1);
  EXPECT_GT(spread(0.9), 1.3);
  // It stops where the water has sunk to the threshold: as far as the drop reaches at 0.5.
  EXPECT_LT(spread(0.9), 1.9);
}

TEST(Blot, AFinerLatticeShowsTheSameBlot) {
  const auto radius = [](double cell_mm) {
    const auto ink = sheet(20, [&](InkSetup& setup) {
      setup.cell_mm = cell_mm;
      setup.threads = 2;
    });
    ink->apply(pour_disc({.contact_s = 2}, 10, 10, 2));
    step(*ink, static_cast<int>(std::lround(2 / ink->step_s())));
    return std::sqrt(marked_mm2(*ink) / 3.14159265);
  };
  const double coarse = radius(0.1);
  EXPECT_GT(coarse, 2.3);
  EXPECT_NEAR(radius(0.05), coarse, 0.05 * coarse);
}

TEST(Blot, DriesInTheTimeItsWaterTakesToEvaporate) {
  const auto ink = sheet(12, [](InkSetup& setup) {
    even_paper(setup.paper);
    setup.flow = false;
    setup.paper.evaporation = 0.01;
    setup.paper.film = 0.8 * setup.paper.capacity;
  });
  ink->apply(pour_disc({}, 6, 6, 3));
  const double seconds = 0.8 * PaperSpec{}.capacity / 0.01;
  step(*ink, static_cast<int>(0.97 * seconds / ink->step_s()));
  EXPECT_FALSE(ink->still());
  step(*ink, static_cast<int>(0.06 * seconds / ink->step_s()));
  EXPECT_TRUE(ink->still());
}

TEST(Blot, WithoutFlowInkDriesWhereItWasLaid) {
  const auto ink = sheet(12, [](InkSetup& setup) { setup.flow = false; });
  ink->apply(pour_disc({.contact_s = 3}, 6, 6, 3));
  ink->step();
  const double laid = marked_mm2(*ink);
  step(*ink, 600);
  EXPECT_EQ(marked_mm2(*ink), laid);
  EXPECT_NEAR(laid, 9 * 3.14159, 1);
}

TEST(Blot, APinnedEdgeThatDriesFasterDrawsPigmentToIt) {
  const auto edge_over_middle = [](double edge_evaporation) {
    const auto ink = sheet(12, [&](InkSetup& setup) {
      even_paper(setup.paper);
      setup.paper.pin_base = 2;
      setup.paper.evaporation = 0.002;
      setup.paper.edge_evaporation = edge_evaporation;
      setup.paper.hindrance = 0;
      setup.paper.hindrance_speed = 0;
      setup.paper.fix_dryness = 0.1;
    });
    ink->apply(pour_disc({.strength = {0.3F, 0, 0, 0}}, 6, 6, 3));
    for (int i = 0; i < 6000 && !ink->still(); ++i) ink->step();
    EXPECT_TRUE(ink->still());
    const InkRegion row = ink->read({30, 60, 60, 1});
    float edge = 0;
    for (std::size_t x = 0; x < 4; ++x) edge = std::max(edge, row.pigment[x][0]);
    return edge / row.pigment[30][0];
  };
  EXPECT_NEAR(edge_over_middle(0), 1, 0.1);
  EXPECT_GT(edge_over_middle(0.0004), 2);
}

TEST(Blot, EveryPaperThatIsSharedLoads) {
  int papers = 0;
  for (const auto& entry : std::filesystem::directory_iterator(FUDE_PAPERS)) {
    const auto paper = load_paper(entry.path());
    ASSERT_TRUE(paper.has_value()) << paper.error().message;
    EXPECT_EQ(paper->name, entry.path().stem());
    ++papers;
  }
  EXPECT_GE(papers, 6);
}

TEST(OpenInk, RefusesWhatHasNoMeaning) {
  const auto fault = [](void (*change)(InkSetup&)) {
    InkSetup setup;
    change(setup);
    const auto ink = open_ink(setup);
    return ink ? Fault::busy : ink.error().fault;
  };
  EXPECT_EQ(fault([](InkSetup& s) { s.cell_mm = 0; }), Fault::usage);
  EXPECT_EQ(fault([](InkSetup& s) { s.width_mm = -1; }), Fault::usage);
  EXPECT_EQ(fault([](InkSetup& s) { s.height_mm = 1e9; }), Fault::usage);
  EXPECT_EQ(fault([](InkSetup& s) { s.threads = 0; }), Fault::usage);
}

}  // namespace
}  // namespace fude
