// Samples of all sources, each at its own time and in whatever order they arrive, become one pose: a late one
// is put where it belongs, and what came after it is taken again.
#pragma once

#include <array>
#include <cstddef>
#include <deque>
#include <optional>
#include <variant>

#include "calibration/fusion/fused_pose.h"
#include "calibration/fusion/leap_watch.h"
#include "calibration/fusion/motion_filter.h"
#include "signal/timestamp.h"

namespace fude {

struct LatenessCounts {
  std::uint64_t late = 0;      // taken after a replay
  std::uint64_t too_late = 0;  // dropped
  std::uint64_t leaps = 0;     // dropped: one time stamp far ahead of all others
  std::uint64_t restarts = 0;  // the clock of all sources began again, and the fusion with it
  std::uint64_t rejoined = 0;  // the clock of one source stepped back beside others that went on
};

class Fusion {
 public:
  explicit Fusion(const FusionSettings& settings = {}, Duration kept = std::chrono::milliseconds(300));

  // False: dropped (not finite, repeated, older than what is kept, far ahead). A source (the inertial unit,
  // or what gives one kind of fix) whose times step back while another goes on is put back where it was among
  // the others, by its mean delay before and after; where none goes on, the fusion begins again.
  bool add(const InertialReading& reading, Timestamp time);
  FixResult add(const Fix& fix, Timestamp time);

  // At the newest sample. The position is continuous: what a fix corrects, a late one or one of another
  // source too, flows in within 0.1 s, never as a jump, unless the position was lost.
  FusedPose pose() const;

  // For the display alone, never to be kept: moving and turning on as at the newest sample, to `at` or as far
  // as longest_prediction. PREDICTED where it is not LOST.
  FusedPose predicted(Timestamp at) const;
  static constexpr Duration longest_prediction = std::chrono::milliseconds(100);

  const MotionFilter& filter() const { return now_; }
  const FusionCounts& counts() const { return now_.counts(); }
  const LatenessCounts& lateness() const { return lateness_; }
  // Added to the times of the source that was last heard, to put it back where it was among the others.
  Duration last_shift() const { return last_shift_; }

 private:
  struct StampedFix {
    Fix fix;
    double assumed_lag_s = 0;
  };
  struct Event {
    Timestamp time{};
    std::variant<InertialReading, StampedFix> what;
  };
  struct Snapshot {
    std::size_t events = 0;  // taken before it, counted from the first ever
    MotionFilter filter;
  };
  struct Source {
    Duration shift{};  // onto the clock of the others
    std::optional<Timestamp> last;
    Duration usual_delay{};  // behind the newest sample of all
    struct TooLate {
      int samples = 0;  // in a row
      bool stepped_back = false;
      std::uint64_t taken_before = 0;
      Duration delays{};  // their sum
    } too_late;
  };

  FixResult take(const Event& event, bool& fresh);
  FixResult insert(Event event, bool& fresh);
  std::optional<Timestamp> on_one_clock(Source& source, Timestamp stamped);
  void restart();
  bool leaps(Timestamp time);
  void forget_old();
  FusedPose shown(const MotionFilter& filter) const;
  void flow(Timestamp before, const Eigen::Vector3d& correction);

  FusionSettings settings_;
  Duration kept_;
  std::deque<Event> events_;
  std::size_t forgotten_ = 0;  // events before events_.front()
  std::deque<Snapshot> snapshots_;
  MotionFilter now_;
  LatenessCounts lateness_;
  LeapWatch leap_watch_;
  std::array<Source, 1 + std::variant_size_v<Fix>> sources_;  // the inertial unit first
  std::uint64_t taken_ = 0;                                   // of all sources
  Duration last_shift_{};
  Eigen::Vector3d withheld_m_ = Eigen::Vector3d::Zero();      // of the corrections, not yet shown
};

}  // namespace fude
