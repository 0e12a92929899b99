#include "rig/import_session.h"

#include "capture/session_writer.h"
#include "drivers/tablet/identify.h"
#include "drivers/tablet/pen_decoder.h"

namespace fude {
namespace {

// Events without a description still belong to some device; its axes are not known.
DeviceDescription undescribed() {
  DeviceDescription device;
  device.name = "a device without a description";
  device.transport = "evdev";
  return device;
}

// Actions go between the samples, where their time puts them.
Result<ImportedStream> write_stream(SessionWriter& out, const RawRecording& recording,
                                    std::span<const Action> actions) {
  ImportedStream stream;
  stream.events = recording.counts.events;
  stream.frames = recording.counts.frames;
  const bool text = !recording.samples.empty() || (recording.device && recording.device->transport == "text");
  const DeviceDescription device = !recording.device ? undescribed()
                                   : text            ? *recording.device
                                                     : identified(*recording.device);
  stream.device = recording.device ? device.name : "";
  stream.raw_only = !text && device.kind != DeviceKind::pen_tablet;

  const auto number = out.add_device(device);
  if (!number) return tl::unexpected(number.error());
  for (const PenSample& sample : recording.samples) {
    if (auto r = out.add_sample(*number, sample); !r) return tl::unexpected(r.error());
    stream.samples += sample.in_proximity;
  }
  PenDecoder decoder(device);
  for (const Transfer& transfer : recording.transfers) {
    for (; !actions.empty() && actions.front().time <= transfer.time; actions = actions.subspan(1))
      if (auto r = out.add_action(actions.front()); !r) return tl::unexpected(r.error());
    if (auto r = out.add_transfer(*number, transfer); !r) return tl::unexpected(r.error());
    if (stream.raw_only) continue;
    if (const auto sample = decoder.decode(transfer))
      if (auto r = out.add_sample(*number, *sample); !r) return tl::unexpected(r.error());
  }
  if (text) {
    bool touching = false;
    for (const PenSample& sample : recording.samples) {
      stream.strokes += sample.in_contact && !touching;
      touching = sample.in_contact;
    }
  } else {
    const DecodeCounts& counts = decoder.counts();
    stream.samples = counts.samples;
    stream.strokes = counts.strokes;
    stream.lost = counts.lost + counts.malformed;
    stream.out_of_range = counts.out_of_range;
  }
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
