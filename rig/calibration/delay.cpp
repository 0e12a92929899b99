#include "rig/calibration/delay.h"

#include <algorithm>
#include <array>
#include <utility>

#include "calibration/delay/delay.h"
#include "calibration/pivot.h"
#include "calibration/surface.h"
#include "rig/calibration/stream_choice.h"

namespace fude {
namespace {

bool shows_the_brush(const Sample& sample) {
  return is_kind<PenSample>(sample) || is_kind<TouchSample>(sample) || is_kind<ImuSample>(sample) ||
         is_kind<PoseSample>(sample) || is_kind<PositionSample>(sample) || is_kind<HapticSample>(sample);
}

class DelayCalibrator final : public Calibrator {
 public:
  DelayCalibrator(DelayWish wish, KnownCalibrations known)
      : wish_(std::move(wish)),
        known_(std::move(known)),
        streams_{choice(wish_.a), choice(wish_.b)},
        procedure_(WitnessReader(wish_.a), WitnessReader(wish_.b)) {}

  void begin(DeviceNumber device, const DeviceDescription& description) override {
    for (StreamChoice& stream : streams_) stream.begin(device, description);
  }

  Result<Progress> hear(DeviceNumber device, const Sample& sample, const Transfer*) override {
    for (const DelaySide side : {DelaySide::a, DelaySide::b}) {
      StreamChoice& stream = streams_[std::size_t(side)];
      const bool first = !stream.chosen();
      const auto mine = stream.takes(device, sample);
      if (!mine) return tl::unexpected(mine.error());
      if (!*mine) continue;
      if (first && is_kind<PoseSample>(sample))
        if (auto told = tell(side, *stream.chosen()); !told) return tl::unexpected(told.error());
      progress_ = procedure_.add(side, sample);
    }
    return progress_;
  }

  Result<CalibrationOutcome> finish() override {
    std::vector<ChosenStream> found;
    for (const StreamChoice& stream : streams_) {
      auto one = stream.found();
      if (!one) return tl::unexpected(one.error());
      found.push_back(std::move(*one));
    }
    const auto delay = procedure_.finish();
    auto outcome = outcome_of(delay);
    outcome.report.tool = found[1].part;
    // A drift counts in its session alone: without devices it is never taken for another.
    if (delay && delay->value.drift_ppm) return outcome;
    for (const ChosenStream& stream : found)
      if (std::find(outcome.report.devices.begin(), outcome.report.devices.end(), stream.device.id) ==
          outcome.report.devices.end())
        outcome.report.devices.push_back(stream.device.id);
    return outcome;
  }

 private:
  static StreamChoice choice(const std::string& name) {
    return StreamChoice({.name = name, .what = "stream", .option = "--streams", .kinds = shows_the_brush});
  }

  // Without a tip the origin of the markers goes for it, and without a surface it is found with the delay.
  Result<void> tell(DelaySide side, const ChosenStream& tool) {
    std::optional<Eigen::Vector3d> tip_m = wish_.tip_m;
    if (!tip_m) {
      const auto pivot = known_.find("pivot", tool);
      if (!pivot) return tl::unexpected(pivot.error());
      if (*pivot)
        if (const auto value = pivot_from((*pivot)->result)) tip_m = value->tip_m;
    }
    const auto known = known_.find("surface", tool);
    if (!known) return tl::unexpected(known.error());
    std::optional<SurfaceCalibration> surface;
    if (*known && tip_m) surface = surface_from((*known)->result);
    procedure_.know(side, tip_m, std::move(surface));
    return {};
  }

  DelayWish wish_;
  KnownCalibrations known_;
  std::array<StreamChoice, 2> streams_;
  DelayProcedure procedure_;
  Progress progress_;
};

}  // namespace

Result<DelayWish> delay_wish(const std::vector<std::string>& streams) {
  constexpr const char* how =
      "give two streams, --streams A,B; where a name has a comma in it, --streams A --streams B";
  DelayWish wish;
  if (streams.size() == 2) {
    wish.a = streams[0];
    wish.b = streams[1];
  } else if (streams.size() == 1 && std::count(streams[0].begin(), streams[0].end(), ',') == 1) {
    const std::size_t comma = streams[0].find(',');
    wish.a = streams[0].substr(0, comma);
    wish.b = streams[0].substr(comma + 1);
  }
  if (wish.a.empty() || wish.b.empty()) return failure(Fault::usage, how);
  if (wish.a == wish.b) return failure(Fault::usage, "the two streams are the same; " + std::string(how));
  return wish;
}

std::unique_ptr<Calibrator> delay_calibrator(DelayWish wish, KnownCalibrations known) {
  return std::make_unique<DelayCalibrator>(std::move(wish), std::move(known));
}

}  // namespace fude
