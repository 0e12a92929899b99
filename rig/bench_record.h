// How well this machine records a whole rig at once.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "rig/record_session.h"
#include "signal/result.h"

namespace fude {

struct RecordBench {
  std::vector<RecordedStream> streams;
  std::int64_t offered = 0;  // transfers that the pretended devices sent
  std::int64_t kept = 0;     // that the session holds
  double cores = 0;          // processor time over wall time, of the whole program
  double peak_mb = 0;        // 10^6 bytes
  double session_mb = 0;
  double delay_us_p50 = 0;  // from byte to sample, of the worst stream
  double delay_us_p99 = 0;
};

// Four tablets at 300 Hz, four brush handles at 1 kHz, two trackers at 240 Hz and a camera of `picture_bytes`
// a picture at 30 Hz, made here and read by the real drivers. `session` is written and removed again.
// Errors: those of RecordingSession.
Result<RecordBench> bench_record(const std::filesystem::path& session, double seconds,
                                 std::size_t picture_bytes);

}  // namespace fude
