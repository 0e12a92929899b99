// What a session holds, stream by stream: for `fude info`.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "capture/session.h"

namespace fude {

struct StreamSummary {
  std::string name;
  std::string kind;  // of the samples ("pen", "imu" …), "raw" or "actions"
  std::int64_t samples = 0;
  double rate_hz = 0;     // one over the median interval; 0 with fewer than two samples
  std::int64_t gaps = 0;  // places where input was lost
  double start_s = 0;     // from the start of the session
  double end_s = 0;
  std::string units;
};

struct SessionSummary {
  std::vector<StreamSummary> streams;
  double duration_s = 0;
  std::vector<std::string> calibration;  // names
  bool complete = false;
};

// What counts as a sample of a pen: a report at whose end the pen is in proximity.
bool counts_as_sample(const PenSample& pen);

// The times of the first and the last input, nothing else; equal where there is none.
struct SessionSpan {
  Timestamp first{};
  Timestamp last{};
};
SessionSpan span_of(const Session& session);

SessionSummary summarise(const Session& session);

}  // namespace fude
