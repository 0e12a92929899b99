// Painting as it happens: samples and actions come from any thread, the ink keeps time, and the
// session records at which step each input was applied, so that a replay gives the same picture.
#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <variant>
#include <vector>

#include "rig/brush_view/tuft_insides.h"
#include "rig/brush_view/tuft_look.h"
#include "rig/history.h"
#include "rig/inputs.h"
#include "rig/pen_manner.h"
#include "rig/recorder.h"
#include "rig/replay.h"
#include "signal/result.h"
#include "sim/brush/brush.h"
#include "sim/ink/ink.h"

namespace fude {

struct LivePen {
  DeviceNumber device = 0;
  PenSample sample;
  TabletMapping mapping;
};

// What the window shows besides the paper.
struct LiveStatus {
  Step step = 0;
  double step_ms = 0;     // of the last ink step
  double latency_ms = 0;  // last sample: from its stamp until the ink can read its deposit
  PenSample pen;
  Eigen::Vector2d nib_mm = Eigen::Vector2d::Zero();
  BrushShape brush;
  std::vector<SeenTuft> hair;
  TuftInsides insides;
  std::int64_t unconverged = 0;  // solves so far
  bool can_undo = false;
  bool can_redo = false;
};

class LivePainting {
 public:
  // `recorder` may be null; it must outlive the painting. `manner` and `sheet` as a replay has them. Returns
  // when the clock of the painting runs.
  LivePainting(Painting painting, const PenReach& reach, Recorder* recorder, const PenManner& manner = {},
               Extent sheet = {});
  ~LivePainting();
  LivePainting(const LivePainting&) = delete;
  LivePainting& operator=(const LivePainting&) = delete;

  // Any thread; never waits for the ink.
  void pen(LivePen pen);
  void act(Action action);

  LiveStatus status() const;

  // What ended the painting before its time: no memory left to paint in, or the graphics card has gone.
  // Nothing is painted or recorded after it.
  std::optional<Error> failed() const;

  // The cells that changed since the last call; nothing while the sheet rests.
  std::optional<InkRegion> take_changes();

  // Applies what is queued, stops, and gives the painting as it stands.
  History& stop();

  // Of every sample so far, milliseconds; after stop().
  const std::vector<double>& latencies_ms() const { return latencies_ms_; }

 private:
  using LiveInput = std::variant<LivePen, Action>;
  void serve();
  void paint();
  void begin();
  void fail(Error error);
  void apply(const LiveInput& input);
  void publish();
  void look(const Ink& ink);

  History history_;
  PenReach reach_;
  HeldPens held_;
  Recorder* recorder_;
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::condition_variable begun_;
  bool started_ = false;
  std::vector<LiveInput> queue_;
  LiveStatus status_;
  std::optional<Error> failed_;
  std::optional<InkRegion> changes_;
  bool looking_ = false;
  CellRect unshown_;  // of the present pass over the sheet
  CellRect was_wet_;  // since it began
  std::vector<double> latencies_ms_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace fude
