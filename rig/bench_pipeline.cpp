#include "rig/bench_pipeline.h"

#include "rig/wet_sheet.h"

namespace fude {

Result<PipelineBench> bench_pipeline(const PaintingSetup& setup, double seconds) {
  auto sheet = WetSheet::open(setup);
  if (!sheet) return tl::unexpected(sheet.error());
  const int reports = (*sheet)->draw(seconds);
  const Painting& done = (*sheet)->stop();
  std::vector<double> microseconds;
  for (const double ms : (*sheet)->latencies_ms()) microseconds.push_back(1e3 * ms);
  return PipelineBench{quantiles(std::move(microseconds)), reports, done.step(),
                       static_cast<std::int64_t>(done.ink().active_cells())};
}

}  // namespace fude
