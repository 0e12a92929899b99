#include "rig/import_session.h"

#include <cstdio>
#include <deque>
#include <optional>
#include <utility>

#include "capture/sample_columns.h"
#include "capture/session_writer.h"
#include "rig/recorded_driver.h"

namespace fude {
namespace {

constexpr std::size_t most_reasons = 64;

// Kept short when a stranger's file gives a thousand reasons.
void pass_over(std::map<std::string, std::uint64_t>& reasons, const std::string& what) {
  if (reasons.size() < most_reasons || reasons.contains(what))
    ++reasons[what];
  else
    ++reasons["other things"];
}

std::string what_came(const Transfer& transfer) {
  char text[64];
  const unsigned number = transfer.payload.empty() ? 0 : std::to_integer<unsigned>(transfer.payload[0]);
  const bool packet = transfer.kind == TransferKind::serial;
  std::snprintf(text, sizeof text, "%s %02x of %zu bytes", packet ? "packets" : "reports", number,
                transfer.payload.size());
  return text;
}

// Takes the samples of one device: into the session, into its counts, and under the line of its clock.
class SampleTray {
 public:
  SampleTray(SessionWriter& out, DeviceNumber device, ImportedStream& stream)
      : out_(out), device_(device), stream_(stream) {}

  Result<void> add(const Sample& sample) {
    if (auto r = out_.add_sample(device_, sample); !r) return tl::unexpected(r.error());
    if (const auto* pen = std::get_if<PenSample>(&sample)) {
      stream_.pen = true;
      stream_.samples += pen->in_proximity;
      stream_.strokes += pen->in_contact && !touching_;
      touching_ = pen->in_contact;
    } else {
      ++stream_.samples;
    }
    const SampleTime& time = time_of(sample);
    if (time.device_tick) ticks_[part_of(sample)].push_back({time.host, *time.device_tick});
    return {};
  }

  Result<void> add_clock_fits(const DeviceDescription& device) {
    if (!device.clock) return {};
    for (const auto& [part, readings] : ticks_)
      for (const ClockLine& line : fit_clock(readings, {.clock = *device.clock}).lines)
        if (auto r = out_.add_clock_fit({device_, part, line}); !r) return r;
    return {};
  }

 private:
  SessionWriter& out_;
  DeviceNumber device_;
  ImportedStream& stream_;
  bool touching_ = false;
  std::map<std::string, std::vector<ClockReading>> ticks_;
};

// One device's recording on its way into the session, input by input.
class StreamWriter {
 public:
  StreamWriter(SessionWriter& out, const RawRecording& recording)
      : out_(out), recording_(recording), driver_(recording.device, recording.transfers) {
    stream_.events = recording.counts.events;
    stream_.frames = recording.counts.frames;
    stream_.passed_over = recording.passed_over;
    stream_.device = recording.device ? driver_.device().name : "";
    stream_.raw_only = !driver_.decodes() && driver_.device().transport != "text";
  }

  Result<void> begin() {
    const auto number = out_.add_device(driver_.device());
    if (!number) return tl::unexpected(number.error());
    number_ = *number;
    tray_.emplace(out_, number_, stream_);
    return {};
  }

  // Of the next input; none at the end.
  std::optional<Timestamp> next_time() const {
    if (transfer_ < recording_.transfers.size()) return recording_.transfers[transfer_].time;
    if (sample_ < recording_.samples.size()) return time_of(recording_.samples[sample_]).host;
    return std::nullopt;
  }

  Result<void> write_next() {
    if (transfer_ == recording_.transfers.size()) return tray_->add(recording_.samples[sample_++]);
    const Transfer& transfer = recording_.transfers[transfer_++];
    if (auto r = out_.add_transfer(number_, transfer); !r) return tl::unexpected(r.error());
    const std::uint64_t before = driver_.not_understood();
    made_.clear();
    driver_.decode(transfer, made_);
    if (driver_.not_understood() > before) pass_over(stream_.passed_over, what_came(transfer));
    for (const Sample& sample : made_)
      if (auto r = tray_->add(sample); !r) return r;
    return {};
  }

  Result<ImportedStream> finish() {
    stream_.lost = driver_.lost();
    stream_.out_of_range = driver_.out_of_range();
    stream_.pen = stream_.pen || driver_.device().kind == DeviceKind::pen_tablet;
    if (auto r = tray_->add_clock_fits(driver_.device()); !r) return tl::unexpected(r.error());
    for (const auto& [what, count] : stream_.passed_over)
      if (auto r = out_.add_passed_over({number_, what, static_cast<std::int64_t>(count)}); !r)
        return tl::unexpected(r.error());
    return stream_;
  }

 private:
  SessionWriter& out_;
  const RawRecording& recording_;
  RecordedDriver driver_;
  DeviceNumber number_ = 0;
  ImportedStream stream_;
  std::optional<SampleTray> tray_;
  std::size_t transfer_ = 0;
  std::size_t sample_ = 0;
  std::vector<Sample> made_;
};

// The one whose next input is the earliest; null at the end of all.
StreamWriter* earliest(std::deque<StreamWriter>& streams) {
  StreamWriter* first = nullptr;
  for (StreamWriter& stream : streams)
    if (const auto time = stream.next_time(); time && (!first || *time < *first->next_time()))
      first = &stream;
  return first;
}

// All in the order of their times, each device's own inputs in theirs; actions where their time puts them.
Result<std::vector<ImportedStream>> write_streams(SessionWriter& out,
                                                  std::span<const RawRecording> recordings,
                                                  std::span<const Action> actions) {
  std::deque<StreamWriter> streams;  // each points into itself
  for (const RawRecording& recording : recordings) {
    streams.emplace_back(out, recording);
    if (auto r = streams.back().begin(); !r) return tl::unexpected(r.error());
  }
  while (StreamWriter* next = earliest(streams)) {
    for (; !actions.empty() && actions.front().time <= *next->next_time(); actions = actions.subspan(1))
      if (auto r = out.add_action(actions.front()); !r) return tl::unexpected(r.error());
    if (auto r = next->write_next(); !r) return tl::unexpected(r.error());
  }
  for (const Action& action : actions)
    if (auto r = out.add_action(action); !r) return tl::unexpected(r.error());
  std::vector<ImportedStream> written;
  for (StreamWriter& stream : streams) {
    auto finished = stream.finish();
    if (!finished) return tl::unexpected(finished.error());
    written.push_back(std::move(*finished));
  }
  return written;
}

}  // namespace

Result<std::vector<ImportedStream>> write_recordings(std::span<const RawRecording> recordings,
                                                     std::span<const Action> actions,
                                                     const std::string& origin,
                                                     const std::filesystem::path& session, bool overwrite,
                                                     const std::map<std::string, std::string>& settings) {
  std::error_code error;
  if (!overwrite && std::filesystem::exists(session, error))
    return failure(Fault::exists, session.string() + " exists already; choose another name or give --force");
  if (std::filesystem::exists(session, error) && !std::filesystem::is_regular_file(session, error))
    return failure(Fault::no_access, session.string() + " is no file; give the name of a session (.fude)");
  const std::filesystem::path unfinished = session.string() + ".part";
  std::filesystem::remove(unfinished, error);
  const auto write = [&]() -> Result<std::vector<ImportedStream>> {
    auto out = SessionWriter::create(unfinished);
    if (!out) return tl::unexpected(out.error());
    if (auto r = out->set("imported_from", origin); !r) return tl::unexpected(r.error());
    for (const auto& [key, value] : settings)
      if (auto r = out->set(key, value); !r) return tl::unexpected(r.error());
    auto streams = write_streams(*out, recordings, actions);
    if (!streams) return streams;
    if (auto r = out->close(); !r) return tl::unexpected(r.error());
    return streams;
  };
  auto streams = write();
  if (streams) {
    std::filesystem::rename(unfinished, session, error);
    if (error)
      streams = failure(Fault::no_access, session.string() + " cannot be written: " + error.message());
  }
  if (!streams)
    for (const char* suffix : {"", "-wal", "-journal", "-shm"})
      std::filesystem::remove(unfinished.string() + suffix, error);
  return streams;
}

Result<ImportReceipt> import_session(const std::filesystem::path& file, const std::filesystem::path& session,
                                     const ImportWish& wish) {
  const auto imported = import_file(file, wish.options);
  if (!imported) return tl::unexpected(imported.error());
  auto streams = write_recordings(imported->recordings, {}, std::string(name_of(imported->format)), session,
                                  wish.overwrite);
  if (!streams) return tl::unexpected(streams.error());
  return ImportReceipt{imported->format, std::move(*streams)};
}

}  // namespace fude
