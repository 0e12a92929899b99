#include "rig/import_session.h"

#include <cstdio>

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

// Actions go between the samples, where their time puts them.
Result<ImportedStream> write_stream(SessionWriter& out, const RawRecording& recording,
                                    std::span<const Action> actions) {
  RecordedDriver driver(recording.device, recording.transfers);
  ImportedStream stream;
  stream.events = recording.counts.events;
  stream.frames = recording.counts.frames;
  stream.passed_over = recording.passed_over;
  stream.device = recording.device ? driver.device().name : "";
  stream.raw_only = !driver.decodes() && driver.device().transport != "text";

  const auto number = out.add_device(driver.device());
  if (!number) return tl::unexpected(number.error());
  SampleTray tray(out, *number, stream);
  std::vector<Sample> made;
  for (const Transfer& transfer : recording.transfers) {
    for (; !actions.empty() && actions.front().time <= transfer.time; actions = actions.subspan(1))
      if (auto r = out.add_action(actions.front()); !r) return tl::unexpected(r.error());
    if (auto r = out.add_transfer(*number, transfer); !r) return tl::unexpected(r.error());
    const std::uint64_t before = driver.not_understood();
    driver.decode(transfer, made);
    if (driver.not_understood() > before) pass_over(stream.passed_over, what_came(transfer));
    for (const Sample& sample : made)
      if (auto r = tray.add(sample); !r) return tl::unexpected(r.error());
    made.clear();
  }
  for (const Sample& sample : recording.samples)
    if (auto r = tray.add(sample); !r) return tl::unexpected(r.error());
  stream.lost = driver.lost();
  stream.out_of_range = driver.out_of_range();
  stream.pen = stream.pen || driver.device().kind == DeviceKind::pen_tablet;
  if (auto r = tray.add_clock_fits(driver.device()); !r) return tl::unexpected(r.error());
  for (const auto& [what, count] : stream.passed_over)
    if (auto r = out.add_passed_over({*number, what, static_cast<std::int64_t>(count)}); !r)
      return tl::unexpected(r.error());
  return stream;
}

}  // namespace

Result<std::vector<ImportedStream>> write_recordings(std::span<const RawRecording> recordings,
                                                     std::span<const Action> actions,
                                                     const std::string& origin,
                                                     const std::filesystem::path& session, bool overwrite) {
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
    std::vector<ImportedStream> streams;
    for (const RawRecording& recording : recordings) {
      auto stream = write_stream(*out, recording, actions);
      if (!stream) return tl::unexpected(stream.error());
      actions = {};
      streams.push_back(std::move(*stream));
    }
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
