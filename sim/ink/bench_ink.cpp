#include "sim/ink/bench_ink.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "sim/compute/copy_bandwidth.h"
#include "sim/ink/sheet_state.h"

namespace fude {
namespace {

constexpr double cell_mm = 0.1;
constexpr int bar_cells = 64;                              // wide: a broad stroke
constexpr int map_cells = 8;                               // of the lattice in one of the map
constexpr std::size_t copy_least = std::size_t{64} << 20;  // bytes: beyond the caches

double charged_bytes(Stage stage) { return stage == Stage::full ? 144 : 72; }

// Bars of ink from the bottom of the sheet up, spread over its width, that together cover the share `wet`.
Deposit bars(int side, double wet) {
  const int columns = (side + map_cells - 1) / map_cells;
  Deposit deposit{{0, 0, map_cells * cell_mm, columns, columns, {}, {}, {}}, {{1, {1, 0.5F, 0.25F, 0.1F}}}};
  const std::size_t size = static_cast<std::size_t>(columns) * static_cast<std::size_t>(columns);
  deposit.map.fresh.assign(size, 0);
  deposit.map.contact_s.assign(size, 0);
  deposit.map.patch.assign(size, 0);
  const int width = bar_cells / map_cells;
  const int places = std::max(1, columns / width);
  auto left = static_cast<std::int64_t>(std::llround(wet * static_cast<double>(size)));
  const int count = std::clamp(static_cast<int>((left + width * columns - 1) / (width * columns)), 1, places);
  for (int bar = 0; bar < count; ++bar) {
    const int first = bar * places / count * width;
    const int last = bar + 1 == count && wet >= 1 ? columns : first + width;
    for (int y = 0; y < columns; ++y)
      for (int x = first; x < last && left > 0; ++x, --left) {
        const auto i =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(x);
        deposit.map.fresh[i] = 1;
        deposit.map.contact_s[i] = 1;
      }
  }
  return deposit;
}

std::size_t wet_cells(Lattice& lattice) {
  std::size_t wet = 0;
  for (const AwakeTile& t : lattice.awake())
    for (int y = 0; y < tile::side; ++y)
      wet += static_cast<std::size_t>(std::ranges::count_if(
          std::span(t.view.cells(tile::rest, y), tile::side), [](float f) { return f > 0; }));
  return wet;
}

double milliseconds(std::chrono::steady_clock::time_point since) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - since).count();
}

// Copies between the steps, so that both see the same neighbours.
template <class StepOnce>
void measure(const InkBenchSetup& setup, ThreadPool& threads, const StepOnce& step_once,
             InkBenchResult& result) {
  const double bytes = charged_bytes(setup.stage);
  const auto copied =
      std::max(copy_least, static_cast<std::size_t>(bytes / 2 * static_cast<double>(result.wet_cells)));
  constexpr int rounds = 4;
  std::vector<double> ms;
  for (int round = 0; round < rounds; ++round) {
    result.copy_gb_s = std::max(result.copy_gb_s, copy_gigabytes_per_second(threads, copied, 3));
    for (int i = round; i < setup.steps; i += rounds) {
      const auto start = std::chrono::steady_clock::now();
      step_once();
      ms.push_back(milliseconds(start));
    }
  }
  std::ranges::sort(ms);
  result.median_ms = ms[ms.size() / 2];
  result.p99_ms = ms[std::min(ms.size() - 1, ms.size() * 99 / 100)];
  result.mlups = static_cast<double>(result.wet_cells) / result.median_ms * 1e-3;
  result.bandwidth_fraction = result.mlups * 1e-3 * bytes / result.copy_gb_s;
}

Result<InkBenchResult> bench_gl(const InkBenchSetup& setup) {
  if (setup.stage != Stage::full || setup.dense)
    return failure(
        Fault::unsupported,
        "OpenGL steps all of the ink on tiles; leave out --stage lattice and --dense, or use --backend cpu");
  const int side = setup.side_cells;
  InkSetup sheet;
  sheet.backend = InkBackend::gl;
  sheet.width_mm = sheet.height_mm = side * cell_mm;
  const auto ink = open_ink(sheet);
  if (!ink) return tl::unexpected(ink.error());
  (*ink)->apply({{}, 1, bars(side, setup.wet)});
  for (int i = 0; i < 5; ++i) (*ink)->step();
  InkBenchResult result{{}, setup.threads, static_cast<std::size_t>(side) * static_cast<std::size_t>(side)};
  for (int row = 0; row < side; ++row)
    for (const float water : (*ink)->read({0, row, side, 1}).flow_water) result.wet_cells += water > 0;
  result.active_cells = (*ink)->active_cells();
  ThreadPool threads(setup.threads);
  measure(
      setup, threads,
      [&] {
        (*ink)->step();
        (void)(*ink)->read({0, 0, 1, 1});  // waits for the card
      },
      result);
  return result;
}

}  // namespace

Result<InkBenchResult> bench_ink(const InkBenchSetup& setup) {
  if (setup.side_cells < 64 || setup.side_cells > 16384)
    return failure(Fault::usage, "--size must be 64 to 16384 cells");
  if (!(setup.wet > 0 && setup.wet <= 1)) return failure(Fault::usage, "--wet must be above 0 and at most 1");
  if (setup.steps < 1) return failure(Fault::usage, "--steps must be at least 1");
  if (setup.threads < 1 || setup.threads > 1024) return failure(Fault::usage, "--threads must be 1 to 1024");
  if (setup.backend == InkBackend::gl) return bench_gl(setup);
  const auto set = choose_instruction_set(setup.instruction_set);
  if (!set) return tl::unexpected(set.error());

  ThreadPool threads(setup.threads);
  const PaperSpec paper;
  const int side = setup.side_cells;
  const LatticeSetup lattice_setup{lattice_numbers(paper, cell_mm),
                                   PaperTexture(paper, 1, cell_mm, side, side, true),
                                   side,
                                   side,
                                   &step_kernels(*set),
                                   &threads};
  const auto lattice = setup.dense ? make_dense_lattice(lattice_setup) : make_tiled_lattice(lattice_setup);
  {
    InkSetup one;
    one.width_mm = one.height_mm = side * cell_mm;
    const auto ink = open_ink(one);
    if (!ink) return tl::unexpected(ink.error());
    (*ink)->apply({{}, 1, bars(side, setup.wet)});
    (*ink)->step();
    load_tiles((*ink)->snapshot().tiles, *lattice);
  }
  for (int i = 0; i < 4; ++i) lattice->step(setup.stage);  // ring awake, caches and pages warm

  InkBenchResult result{*set, setup.threads, static_cast<std::size_t>(side) * static_cast<std::size_t>(side)};
  result.wet_cells = wet_cells(*lattice);
  measure(
      setup, threads, [&] { lattice->step(setup.stage); }, result);
  result.active_cells = lattice->awake().size() * tile::cells;
  return result;
}

}  // namespace fude
