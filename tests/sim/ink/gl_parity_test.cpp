// The ink by OpenGL against the ink on the processor. On a software renderer (llvmpipe) the fields are equal
// bit for bit; a card may round otherwise, within the limits of the last test.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <iostream>
#include <thread>

#include "sim/compute/gl_context.h"
#include "sim/optics/colour.h"
#include "tests/sim/ink/strokes.h"

namespace fude {
namespace {

constexpr double side_mm = 12;

std::unique_ptr<Ink> on(InkBackend backend, double evaporation = 0.02) {
  return sheet(side_mm, [&](InkSetup& setup) {
    setup.backend = backend;
    setup.paper.evaporation = evaporation;
  });
}

// Fronts that cross many tiles, meet, dry and are wetted again; two patches share cells.
void performance(Ink& ink, int steps_after) {
  for (std::uint64_t i = 0; i < 8; ++i) {
    InkEvent event = pour_disc({.strength = {1, 0.2F, 0, 0.3F}, .contact_s = 0.1F},
                               1.5 + 1.2 * static_cast<double>(i), 6, 0.9, i);
    auto& deposit = std::get<Deposit>(event.what);
    deposit.patches.push_back({0.4F, {0.2F, 0, 1, 0}});
    for (std::size_t cell = 0; cell < deposit.map.patch.size(); cell += 3) deposit.map.patch[cell] = 1;
    ink.apply(event);
    step(ink, 5);
  }
  step(ink, steps_after);
}

void expect_equal(const std::vector<InkSnapshot::Tile>& gl, const std::vector<InkSnapshot::Tile>& cpu) {
  ASSERT_EQ(gl.size(), cpu.size());
  for (std::size_t t = 0; t < cpu.size(); ++t) {
    ASSERT_EQ(gl[t].row, cpu[t].row);
    ASSERT_EQ(gl[t].column, cpu[t].column);
    ASSERT_EQ(gl[t].planes.size(), cpu[t].planes.size());
    for (std::size_t i = 0; i < cpu[t].planes.size(); ++i)
      ASSERT_EQ(std::bit_cast<std::uint32_t>(gl[t].planes[i] + 0.0F),
                std::bit_cast<std::uint32_t>(cpu[t].planes[i] + 0.0F))
          << "tile " << cpu[t].column << ", " << cpu[t].row << ", plane " << i / 1024 << ", cell " << i % 1024
          << ": " << gl[t].planes[i] << " for " << cpu[t].planes[i];
  }
}

bool rounds_as_the_processor() {
  const auto context = GlContext::open(GlContext::Renderer::any);
  return context && is_software_renderer(context->renderer());
}

TEST(GlParity, FieldsAreEqualBitForBitOnASoftwareRenderer) {
  if (!rounds_as_the_processor()) {
    std::cout << "on a graphics card: the fields are held to the tolerance of the picture alone\n";
    return;
  }
  const auto cpu = on(InkBackend::cpu, 0.0015);
  const auto gl = on(InkBackend::gl, 0.0015);
  for (Ink* ink : {cpu.get(), gl.get()}) performance(*ink, 960);
  ASSERT_EQ(gl->steps(), 1000U);
  EXPECT_GT(cpu->totals().water_left, 0.1 * cpu->totals().water_deposited);
  expect_equal(gl->snapshot().tiles, cpu->snapshot().tiles);
  EXPECT_EQ(gl->hash(), cpu->hash());
}

TEST(GlParity, TilesFallAsleepAndWakeWithoutATrace) {
  if (!rounds_as_the_processor()) return;
  const auto cpu = on(InkBackend::cpu, 0.02);
  const auto gl = on(InkBackend::gl, 0.02);
  std::size_t most = 0;
  for (Ink* ink : {cpu.get(), gl.get()}) {
    performance(*ink, 150);
    most = std::max(most, gl->active_cells());
    ink->apply(pour_disc({.strength = {0, 1, 0, 0}, .contact_s = 0.3F}, 6, 8, 1.5, 20));
    step(*ink, 300);
  }
  expect_equal(gl->snapshot().tiles, cpu->snapshot().tiles);
  EXPECT_FALSE(gl->still());
  step(*gl, 900);
  step(*cpu, 900);
  EXPECT_TRUE(cpu->still());
  EXPECT_TRUE(gl->still());
  step(*gl, 40);
  EXPECT_LT(gl->active_cells(), most);
  EXPECT_EQ(gl->hash(), cpu->hash());
}

TEST(GlParity, BrushesGetBackTheSameAndBalancesClose) {
  const auto cpu = on(InkBackend::cpu);
  const auto gl = on(InkBackend::gl);
  for (Ink* ink : {cpu.get(), gl.get()}) performance(*ink, 60);
  const InkTotals want = cpu->totals();
  const InkTotals got = gl->totals();
  EXPECT_NEAR(got.water_deposited, want.water_deposited, 1e-3 * want.water_deposited);
  EXPECT_NEAR(got.water_evaporated, want.water_evaporated, 1e-3 * want.water_deposited);
  EXPECT_NEAR(got.water_evaporated + got.water_left, got.water_deposited, 1e-4 * got.water_deposited);
  for (std::size_t c = 0; c < concentrations_per_group; ++c) {
    EXPECT_NEAR(got.pigment_deposited[c], want.pigment_deposited[c], 1e-3 * want.pigment_deposited[c]);
    EXPECT_NEAR(got.pigment_fixed[c], want.pigment_fixed[c], 1e-3 * want.pigment_deposited[c]);
    EXPECT_NEAR(got.pigment_surface[c] + got.pigment_flow[c] + got.pigment_fixed[c], got.pigment_deposited[c],
                1e-4 * got.pigment_deposited[c]);
  }
  const auto own = gl->collect();
  const auto reference = cpu->collect();
  ASSERT_EQ(own.size(), reference.size());
  for (std::size_t i = 0; i < own.size(); ++i) {
    EXPECT_EQ(own[i].event, reference[i].event);
    ASSERT_EQ(own[i].patches.size(), 2U);
    for (std::size_t p = 0; p < 2; ++p)
      EXPECT_NEAR(own[i].patches[p].water_ul, reference[i].patches[p].water_ul, 1e-6);
  }
}

TEST(GlParity, SnapshotsCrossBetweenTheBackEnds) {
  const auto cpu = on(InkBackend::cpu);
  const auto gl = on(InkBackend::gl);
  performance(*gl, 30);
  gl->apply(pour_disc({}, 5, 5, 1, 77));
  const InkSnapshot then = gl->snapshot();
  EXPECT_EQ(then.pending.size(), 1U);
  EXPECT_EQ(then.ready.size(), 8U);
  const auto go_on = [](Ink& ink) {
    ink.apply(pour_disc({.strength = {0, 1, 0, 0}}, 4, 4, 2, 30));
    step(ink, 100);
  };
  go_on(*gl);
  const InkTotals once = gl->totals();
  const InkRegion seen = gl->read({0, 0, 120, 120});
  cpu->restore(then);
  go_on(*cpu);
  gl->restore(then);
  go_on(*gl);
  for (const Ink* ink : {cpu.get(), gl.get()}) {
    EXPECT_NEAR(ink->totals().water_left, once.water_left, 1e-3 * once.water_deposited);
    EXPECT_NEAR(ink->totals().water_evaporated, once.water_evaporated, 1e-3 * once.water_deposited);
    EXPECT_NEAR(ink->totals().pigment_fixed[0], once.pigment_fixed[0], 1e-3 * once.pigment_deposited[0]);
  }
  EXPECT_EQ(gl->read({0, 0, 120, 120}).pigment, seen.pigment);
  EXPECT_EQ(gl->collect().size(), 10U);
}

TEST(GlParity, DryingTheWholeSheetFixesEverything) {
  const auto cpu = on(InkBackend::cpu);
  const auto gl = on(InkBackend::gl);
  for (Ink* ink : {cpu.get(), gl.get()}) {
    performance(*ink, 20);
    ink->apply({Duration{}, 50, DryPaper{}});
    step(*ink, 2);
  }
  const InkTotals got = gl->totals();
  EXPECT_EQ(got.water_left, 0);
  EXPECT_NEAR(got.water_evaporated, got.water_deposited, 1e-4 * got.water_deposited);
  EXPECT_NEAR(got.pigment_fixed[0], cpu->totals().pigment_fixed[0], 1e-3 * got.pigment_fixed[0]);
  EXPECT_TRUE(gl->still());
}

TEST(GlParity, AnotherThreadMayGoOn) {
  const auto gl = on(InkBackend::gl);
  performance(*gl, 5);
  std::uint64_t hash_there = 0;
  std::thread([&] {
    gl->step();
    hash_there = gl->hash();
  }).join();
  EXPECT_EQ(gl->hash(), hash_there);
}

TEST(GlParity, PicturesLookTheSame) {
  const auto cpu = on(InkBackend::cpu, 0.0015);
  const auto gl = on(InkBackend::gl, 0.0015);
  const Palette palette{{pigments()[0], *find_pigment("french-ultramarine"), *find_pigment("hansa-yellow")}};
  const auto picture = [&](Ink& ink) {
    performance(ink, 400);
    const InkRegion region = ink.read({0, 0, ink.columns(), ink.rows()});
    Picture seen(region.rect.columns, region.rect.rows);
    colour_row(region.pigment, palette, seen.pixels);
    return seen;
  };
  const Picture want = picture(*cpu);
  const Picture got = picture(*gl);
  ASSERT_EQ(got.pixels.size(), want.pixels.size());
  const Rgb16 paper = want.pixels.front();
  double sum = 0;
  int values = 0;
  int far = 0;
  for (std::size_t i = 0; i < want.pixels.size(); ++i) {
    if (want.pixels[i] == paper && got.pixels[i] == paper) continue;
    for (std::size_t band = 0; band < 3; ++band) {
      const double apart = std::abs(want.pixels[i][band] - got.pixels[i][band]) / 257.0;
      sum += apart;
      far += apart > 4;
      ++values;
    }
  }
  ASSERT_GT(values, 5000);
  EXPECT_LE(sum / values, 1);
  EXPECT_LE(far, values / 1000);
}

}  // namespace
}  // namespace fude
