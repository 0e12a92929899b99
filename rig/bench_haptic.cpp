#include "rig/bench_haptic.h"

#include <atomic>
#include <memory>
#include <thread>
#include <utility>

#include "drivers/falcon/simulated_arm.h"
#include "drivers/transport/waker.h"
#include "rig/arm_on_paper.h"
#include "rig/haptic_reader.h"
#include "rig/precedence.h"
#include "rig/wet_sheet.h"
#include "signal/elementary.h"

namespace fude {
namespace {

constexpr double turn_s = 0.5;
constexpr Duration model_holds = std::chrono::milliseconds(20);  // four reports of the pen

void add(falcon::Pace::Counts& all, const falcon::Pace::Counts& more) {
  all.periods += more.periods;
  all.late += more.late;
}

class BareTimer {
 public:
  BareTimer() : thread_([this] { serve(); }) {}
  ~BareTimer() { stop(); }
  BareTimer(const BareTimer&) = delete;
  BareTimer& operator=(const BareTimer&) = delete;

  falcon::Pace::Counts stop() {
    stopping_ = true;
    if (thread_.joinable()) thread_.join();
    return pace_.counts();
  }
  bool precedence() const { return precedence_; }  // after stop()

 private:
  void serve() {
    precedence_ = ask_for(Precedence::arm);
    while (!stopping_) pace_.wait();
  }

  falcon::MonotonicLoopClock clock_;
  falcon::Pace pace_{clock_};
  bool precedence_ = false;
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

// Circles of 2 cm, a little over a turn a second, half of each below the plain sheet.
Eigen::Vector3d circling_hand(Timestamp time) {
  const elementary::SineCosine turn = elementary::sine_cosine(8 * seconds(time.time_since_epoch()));
  return {0.02 * turn.cosine, 0.002 * turn.sine, 0.02 * turn.sine};
}

class LedArm {
 public:
  LedArm(Newest<ContactModel>& models, std::int64_t& felt)
      : reader_(
            std::make_unique<falcon::SimulatedArm>(circling_hand), decoder_,
            [&felt](const Transfer&, std::span<const Sample> samples) {
              for (const Sample& sample : samples)
                felt += std::get<HapticSample>(sample).force_n.isZero() ? 0 : 1;
            },
            wish(models)) {}

  falcon::HapticLoop::Counts stop() {
    reader_.stop();
    return reader_.counts();
  }

 private:
  static HapticWish wish(Newest<ContactModel>& models) {
    HapticWish wish;
    wish.feel = feel_of(models, {});
    return wish;
  }

  FalconDecoder decoder_{{}, false};
  HapticReader reader_;
};

class HapticTrial {
 public:
  HapticTrial(WetSheet& sheet, HapticBench& bench) : sheet_(sheet), bench_(bench) {}

  void run(double for_s, bool timer, bool loop) {
    std::unique_ptr<BareTimer> bare;
    std::unique_ptr<LedArm> arm;
    if (timer) bare = std::make_unique<BareTimer>();
    if (loop) arm = std::make_unique<LedArm>(models_, bench_.felt);
    sheet_.draw(for_s, [this] { models_.put(paper_plane(0, monotonic_now() + model_holds)); });
    if (bare) {
      add(bench_.timer, bare->stop());
      bench_.precedence = bare->precedence();
    }
    if (arm) {
      const falcon::HapticLoop::Counts counts = arm->stop();
      add(bench_.loop, counts.pace);
      bench_.samples += static_cast<std::int64_t>(counts.samples);
    }
  }

 private:
  WetSheet& sheet_;
  HapticBench& bench_;
  Newest<ContactModel> models_;
};

double late_share(const falcon::Pace::Counts& counts) {
  return counts.periods == 0 ? 0 : static_cast<double>(counts.late) / static_cast<double>(counts.periods);
}

}  // namespace

Result<HapticBench> bench_haptic(const PaintingSetup& setup, double seconds, HapticTurns turns) {
  auto sheet = WetSheet::open(setup);
  if (!sheet) return tl::unexpected(sheet.error());
  HapticBench bench;
  HapticTrial trial(**sheet, bench);
  if (turns == HapticTurns::together) {
    trial.run(seconds, true, true);
  } else {
    for (double done_s = 0; done_s < seconds; done_s += turn_s) {
      trial.run(turn_s, true, false);
      trial.run(turn_s, false, true);
    }
  }
  bench.steps = (*sheet)->stop().step();
  return bench;
}

double late_excess(const HapticBench& bench) { return late_share(bench.loop) - late_share(bench.timer); }

}  // namespace fude
