#include "rig/import_session.h"

#include "capture/session_writer.h"
#include "drivers/tablet/identify.h"
#include "drivers/tablet/pen_decoder.h"

namespace fude {
namespace {

// Events without a description still belong to some device; its axes are not known.
DeviceDescription undescribed(const std::filesystem::path& file) {
  DeviceDescription device;
  device.name = file.filename().string();
  device.transport = "evdev";
  return device;
}

Result<ImportedStream> write_stream(SessionWriter& out, const RawRecording& recording,
                                    const std::filesystem::path& file) {
  ImportedStream stream;
  stream.events = recording.counts.events;
  stream.frames = recording.counts.frames;
  const bool text = !recording.samples.empty() || (recording.device && recording.device->transport == "text");
  const DeviceDescription device = !recording.device ? undescribed(file)
                                   : text            ? *recording.device
                                                     : identified(*recording.device);
  stream.device = recording.device ? device.name : "";
  stream.raw_only = !text && device.kind != DeviceKind::pen_tablet;

  const auto number = out.add_device(device);
  if (!number) return tl::unexpected(number.error());
  for (const PenSample& sample : recording.samples) {
    if (auto r = out.add_pen(*number, sample); !r) return tl::unexpected(r.error());
    stream.samples += sample.in_proximity;
  }
  PenDecoder decoder(device);
  for (const Transfer& transfer : recording.transfers) {
    if (auto r = out.add_transfer(*number, transfer); !r) return tl::unexpected(r.error());
    if (stream.raw_only) continue;
    if (const auto sample = decoder.decode(transfer))
      if (auto r = out.add_pen(*number, *sample); !r) return tl::unexpected(r.error());
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

Result<ImportReceipt> import_session(const std::filesystem::path& file, const std::filesystem::path& session,
                                     const ImportWish& wish) {
  std::error_code error;
  if (!wish.overwrite && std::filesystem::exists(session, error))
    return failure(Fault::usage, session.string() + " exists already; choose another name or give --force");
  const auto imported = import_file(file, wish.options);
  if (!imported) return tl::unexpected(imported.error());

  const std::filesystem::path unfinished = session.string() + ".part";
  std::filesystem::remove(unfinished, error);
  const auto write = [&]() -> Result<ImportReceipt> {
    auto out = SessionWriter::create(unfinished);
    if (!out) return tl::unexpected(out.error());
    ImportReceipt receipt{imported->format, {}};
    if (auto r = out->set("imported_from", std::string(name_of(imported->format))); !r)
      return tl::unexpected(r.error());
    for (const RawRecording& recording : imported->recordings) {
      auto stream = write_stream(*out, recording, file);
      if (!stream) return tl::unexpected(stream.error());
      receipt.streams.push_back(std::move(*stream));
    }
    if (auto r = out->close(); !r) return tl::unexpected(r.error());
    return receipt;
  };
  auto receipt = write();
  if (receipt) {
    std::filesystem::rename(unfinished, session, error);
    if (error)
      receipt = failure(Fault::no_access, session.string() + " cannot be written: " + error.message());
  }
  if (!receipt) {
    for (const char* suffix : {"", "-wal", "-journal", "-shm"})
      std::filesystem::remove(unfinished.string() + suffix, error);
  }
  return receipt;
}

}  // namespace fude
