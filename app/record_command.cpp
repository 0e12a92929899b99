#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "app/commands.h"
#include "app/interrupt.h"
#include "app/progress_line.h"
#include "capture/session_words.h"
#include "drivers/transport/waker.h"
#include "rig/calibration/calibration_store.h"
#include "rig/named_device.h"
#include "rig/record_session.h"

namespace fude {
namespace {

struct Options {
  std::string out;
  std::vector<std::string> named;
  std::string report;
  double seconds = 0;  // 0: until Ctrl-C
  bool force = false;
  std::string camera_size;
  std::string camera_format;
  std::optional<double> camera_exposure_ms;
  std::string frames = "as-sent";
  CameraSettings camera;
};

using Json = nlohmann::ordered_json;

// Of the latest run of the device's clock.
Json clock_fit(const std::vector<ClockLine>& lines) {
  if (lines.empty() || lines.back().readings < 2) return nullptr;
  const ClockLine& line = lines.back();
  const auto drift = line.drift_ppm();
  return {{"offset_ns", line.offset.time_since_epoch().count()},
          {"drift_ppm", drift ? Json(*drift) : Json()},
          {"residual_us", line.residual_s.p50 * 1e6}};
}

Json pictures(const std::optional<FrameKeeper::Counts>& frames) {
  if (!frames) return nullptr;
  return {{"as_wished", frames->as_wished}, {"as_sent", frames->as_sent}};
}

Json as_json(const std::vector<RecordedStream>& streams) {
  Json all = Json::object();
  for (const RecordedStream& s : streams)
    all[s.device] = {{"expected", s.expected},
                     {"received", s.received},
                     {"dropped", s.dropped},
                     {"gaps", s.figures.gaps},
                     {"rate_hz", s.figures.rate_hz},
                     {"jitter_us",
                      {{"p50", s.figures.jitter_us.p50},
                       {"p99", s.figures.jitter_us.p99},
                       {"max", s.figures.jitter_us.largest}}},
                     {"delay_us",
                      {{"p50", s.figures.delay_us.p50},
                       {"p99", s.figures.delay_us.p99},
                       {"max", s.figures.delay_us.largest}}},
                     {"clock_fit", clock_fit(s.figures.clock)},
                     {"pictures", pictures(s.frames)}};
  return {{"streams", all}};
}

int write_report(const std::string& path, const std::vector<RecordedStream>& streams) {
  std::ofstream file(path);
  file << as_json(streams).dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
  file.flush();
  if (file) return 0;
  return report({Fault::storage, path + " cannot be written; choose another name for the report"});
}

FrameEncoding frame_encoding(const std::string& word) {
  if (word == "png") return FrameEncoding::png;
  return word == "jpeg" ? FrameEncoding::jpeg : FrameEncoding::as_sent;
}

// "1280x720".
std::string size_fault(const std::string& text) {
  std::int32_t width = 0, height = 0;
  char cross = 0;
  std::string rest;
  std::istringstream words(text);
  const bool read = words >> width >> cross >> height && !(words >> rest);
  const auto fits = [](std::int32_t side) { return side >= 1 && side <= 65535; };
  return read && cross == 'x' && fits(width) && fits(height) ? "" : "give a size as 1280x720";
}

CameraSettings camera_settings(const Options& options) {
  CameraSettings camera = options.camera;
  if (!options.camera_size.empty()) {
    char cross = 0;
    std::istringstream(options.camera_size) >> camera.width >> cross >> camera.height;
  }
  if (!options.camera_format.empty()) camera.format = value_for<PixelFormat>(options.camera_format);
  if (options.camera_exposure_ms) camera.exposure_s = *options.camera_exposure_ms / 1e3;
  return camera;
}

// Until `limit_s` is over (0: never) or Ctrl-C, which gives true.
bool stand(InterruptWatch& interrupt, const RecordingSession& recording, double limit_s) {
  constexpr Duration between_looks = std::chrono::milliseconds(200);
  const Timestamp start = monotonic_now();
  const ProgressLine line("recorded");
  for (;;) {
    const double left_s = limit_s > 0 ? limit_s - seconds(monotonic_now() - start) : 1e9;
    if (left_s <= 0) return false;
    const auto left = std::chrono::duration_cast<Duration>(std::chrono::duration<double>(left_s));
    if (interrupt.wait(std::min(left, between_looks))) return true;
    line.show(recording.samples(), "samples");
  }
}

int record(const Options& options) {
  InterruptWatch interrupt;  // before any thread starts
  std::vector<std::string> warnings;
  RecordingWish wish{.overwrite = options.force,
                     .named = {},
                     .camera = camera_settings(options),
                     .frames = frame_encoding(options.frames),
                     .calibrations = calibrations_of_user(warnings)};
  for (const std::string& warning : warnings) std::fprintf(stderr, "fude: %s\n", warning.c_str());
  for (const std::string& name : options.named) {
    auto device = named_device(name);
    if (!device) return report(device.error());
    wish.named.push_back(std::move(*device));
  }
  auto recording = RecordingSession::start(options.out, std::move(wish), [](const std::string& warning) {
    std::fprintf(stderr, "fude: %s\n", warning.c_str());
  });
  if (!recording) return report(recording.error());
  std::fprintf(stderr, "recording into %s; Ctrl-C ends it\n", options.out.c_str());
  const bool interrupted = stand(interrupt, **recording, options.seconds);
  const auto streams = (*recording)->finish();
  if (!streams) return report(streams.error());
  for (const RecordedStream& stream : *streams) {
    std::printf("%s: expected %lld, received %lld, dropped %lld\n", stream.device.c_str(),
                static_cast<long long>(stream.expected), static_cast<long long>(stream.received),
                static_cast<long long>(stream.dropped));
    if (stream.frames && stream.frames->as_sent > 0)
      std::printf("%s: %llu of %llu pictures are kept as sent, damaged or too many at once for --frames %s\n",
                  stream.device.c_str(), static_cast<unsigned long long>(stream.frames->as_sent),
                  static_cast<unsigned long long>(stream.frames->as_sent + stream.frames->as_wished),
                  options.frames.c_str());
  }
  if (!options.report.empty())
    if (const int failed = write_report(options.report, *streams); failed != 0) return failed;
  return interrupted ? 130 : 0;
}

}  // namespace

void add_record(CLI::App& app, int& status) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("record", "records every device that is plugged in");
  command->add_option("--out", options->out, "the session to write (.fude)")->required();
  command->add_option("--add", options->named,
                      "a device that is not found by itself: fastrak:/dev/ttyS0@115200, "
                      "openigtlink:HOST:PORT, vrpn:HOST …; may be given again");
  command->add_option("--seconds", options->seconds, "how long; without it until Ctrl-C")
      ->check(CLI::Range(0.001, 1e6));
  command->add_option("--report", options->report, "a JSON file of what each stream gave");
  command->add_option("--camera-size", options->camera_size, "of every camera's pictures; default: 1280x720")
      ->check(size_fault);
  command->add_option("--camera-rate", options->camera.rate_hz, "pictures a second; default: 30")
      ->check(CLI::Range(0.01, 10000.0));
  command->add_option("--camera-format", options->camera_format, "default: the first that the camera has")
      ->check(CLI::IsMember({"mjpeg", "yuyv", "grey"}));
  command->add_option("--camera-exposure-ms", options->camera_exposure_ms, "held, not automatic")
      ->check(CLI::Range(0.1, 100000.0));
  command->add_option("--camera-gain", options->camera.gain, "held, in the camera's own units");
  command->add_option("--camera-focus", options->camera.focus, "held, in the camera's own units");
  command
      ->add_option("--frames", options->frames,
                   "how pictures are kept; png loses nothing, jpeg is smaller; default: as-sent")
      ->check(CLI::IsMember({"as-sent", "png", "jpeg"}));
  command->add_flag("--force", options->force, "replace an existing session");
  command->callback([options, &status] { status = record(*options); });
}

}  // namespace fude
