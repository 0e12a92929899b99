#include "capture/import/import.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <span>
#include <string>
#include <system_error>
#include <utility>

#include "capture/import/evemu.h"
#include "capture/import/gzip.h"
#include "capture/import/hid_recorder.h"
#include "capture/import/images.h"
#include "capture/import/imu_csv.h"
#include "capture/import/joycon_uart.h"
#include "capture/import/libinput_record.h"
#include "capture/import/mypaint_events.h"
#include "capture/import/poses_csv.h"
#include "capture/import/svc.h"
#include "capture/import/timestamps_csv.h"
#include "capture/import/usbhid_dump.h"
#include "capture/import/wacom_ink_csv.h"

namespace fude {
namespace {

using Recordings = Result<std::vector<RawRecording>>;

Recordings one(Result<RawRecording> recording) {
  if (!recording) return tl::unexpected(recording.error());
  std::vector<RawRecording> all;
  all.push_back(std::move(*recording));
  return all;
}

Recordings from_picture(std::string_view, const ImportOptions&) {
  return failure(Fault::usage, "pictures are read from their files; name a folder, a pattern or a picture");
}

bool looks_like_picture(std::string_view bytes) {
  return picture_head(std::as_bytes(std::span(bytes.data(), bytes.size()))).has_value();
}

// Recognised in this order: a format that says more stands before one that asks for less.
struct Format {
  ImportFormat format;
  std::string_view name;
  bool (*looks_like)(std::string_view);
  Recordings (*read)(std::string_view, const ImportOptions&);
};
constexpr std::array<Format, 12> formats{{
    {ImportFormat::images, "images", looks_like_picture, from_picture},
    {ImportFormat::hid_recorder, "hid-recorder", looks_like_hid_recorder,
     [](std::string_view text, const ImportOptions&) { return import_hid_recorder(text); }},
    {ImportFormat::usbhid_dump, "usbhid-dump", looks_like_usbhid_dump,
     [](std::string_view text, const ImportOptions&) { return import_usbhid_dump(text); }},
    {ImportFormat::evemu, "evemu", looks_like_evemu,
     [](std::string_view text, const ImportOptions&) { return one(import_evemu(text)); }},
    {ImportFormat::libinput, "libinput", looks_like_libinput_record,
     [](std::string_view text, const ImportOptions&) { return import_libinput_record(text); }},
    {ImportFormat::joycon_uart, "joycon-uart", looks_like_joycon_uart,
     [](std::string_view text, const ImportOptions&) { return one(import_joycon_uart(text)); }},
    {ImportFormat::imu_csv, "imu-csv", looks_like_imu_csv,
     [](std::string_view text, const ImportOptions& o) { return import_imu_csv(text, o.rate_hz); }},
    {ImportFormat::poses_csv, "poses-csv", looks_like_poses_csv,
     [](std::string_view text, const ImportOptions& o) {
       return one(import_poses_csv(text, {o.rate_hz, o.metres_per_unit}));
     }},
    {ImportFormat::timestamps_csv, "timestamps-csv", looks_like_timestamps_csv,
     [](std::string_view text, const ImportOptions&) { return one(import_timestamps_csv(text)); }},
    {ImportFormat::wacom_ink_csv, "wacom-ink-csv", looks_like_wacom_ink_csv,
     [](std::string_view text, const ImportOptions& o) {
       return one(import_wacom_ink_csv(text, o.per_pixel.value_or(default_mm_per_ink_pixel)));
     }},
    {ImportFormat::svc, "svc", looks_like_svc,
     [](std::string_view text, const ImportOptions&) { return one(import_svc(text)); }},
    {ImportFormat::mypaint_events, "mypaint-events", looks_like_mypaint_events,
     [](std::string_view text, const ImportOptions& o) {
       return one(import_mypaint_events(text, o.per_pixel.value_or(default_mm_per_pixel)));
     }},
}};

const Format& row_of(ImportFormat format) {
  return *std::find_if(formats.begin(), formats.end(), [&](const Format& f) { return f.format == format; });
}

Error at(const std::filesystem::path& file, Error error) {
  error.message = file.string() + ": " + error.message;
  return error;
}

// A message may quote a stranger's bytes: it stays one line all the same.
Error printable(Error error) {
  std::replace_if(
      error.message.begin(), error.message.end(), [](char c) { return c >= 0 && (c < ' ' || c == 127); },
      '?');
  return error;
}

Result<std::string> read_whole(const std::filesystem::path& file) {
  std::error_code status;
  if (std::filesystem::is_directory(file, status))
    return failure(Fault::not_found, file.string() + " is a folder; name a file in it");
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  if (!stream) {
    const int reason = errno;
    if (reason == EACCES)
      return failure(Fault::no_access, "no permission to read " + file.string() + "; try `chmod +r` on it");
    return failure(Fault::not_found, file.string() + ": " + std::strerror(reason != 0 ? reason : ENOENT));
  }
  // A pipe has no size, so read until the limit rather than ask.
  std::string bytes;
  std::array<char, 65536> block;
  while (stream.read(block.data(), block.size()) || stream.gcount() > 0) {
    bytes.append(block.data(), static_cast<std::size_t>(stream.gcount()));
    if (bytes.size() > largest_import)
      return failure(Fault::unsupported, file.string() + " is larger than 256 MiB; split the recording");
  }
  return bytes;
}

Result<std::string> unpacked(std::string_view bytes) {
  if (is_gzip(bytes)) return unpack_gzip(bytes);
  return std::string(bytes);
}

Result<DeviceDescription> read_description(const std::filesystem::path& file) {
  return read_whole(file)
      .and_then([](const std::string& bytes) { return unpacked(bytes); })
      .and_then([](const std::string& text) { return read_evemu_description(text); })
      .map_error([&](Error error) {
        return error.message.find(file.string()) == std::string::npos ? at(file, std::move(error)) : error;
      });
}

std::optional<std::filesystem::path> description_beside(const std::filesystem::path& file) {
  std::error_code status;
  const auto folder = file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
  std::optional<std::filesystem::path> best;
  const auto length = [](const std::filesystem::path& path) { return path.stem().native().size(); };
  for (std::filesystem::directory_iterator entry(folder, status), end; !status && entry != end;
       entry.increment(status)) {
    const std::filesystem::path& path = entry->path();
    if (path.extension() != ".desc" || path.filename() == file.filename()) continue;
    if (!file.filename().native().starts_with(path.stem().native())) continue;
    if (!best || length(path) > length(*best)) best = path;
  }
  return best;
}

// One tablet a page: all interfaces of the dump are taken for its.
void take_page_beside(const std::filesystem::path& file, ImportedFile& imported) {
  const std::filesystem::path page = file.parent_path() / "index.md";
  std::error_code status;
  if (!std::filesystem::is_regular_file(page, status)) return;
  const auto text = read_whole(page);
  const auto described = text ? read_tablet_page(*text) : std::nullopt;
  if (!described) return;
  imported.description = page;
  for (RawRecording& recording : imported.recordings) {
    DeviceDescription device = *described;
    device.transport = recording.device->transport;
    device.hid_descriptor = recording.device->hid_descriptor;
    device.id = device_id(device);
    recording.device = std::move(device);
  }
}

}  // namespace

std::optional<ImportFormat> import_format(std::string_view name) {
  for (const Format& f : formats)
    if (f.name == name) return f.format;
  return std::nullopt;
}

std::string_view name_of(ImportFormat format) { return row_of(format).name; }

std::vector<std::string> import_format_names() {
  std::vector<std::string> names;
  for (const Format& f : formats) names.emplace_back(f.name);
  std::sort(names.begin(), names.end());
  return names;
}

std::optional<ImportFormat> recognise(std::string_view text) {
  for (const Format& f : formats)
    if (f.looks_like(text)) return f.format;
  return std::nullopt;
}

Result<ImportedFile> import_bytes(std::string_view bytes, const ImportOptions& options) {
  const auto text = unpacked(bytes);
  if (!text) return tl::unexpected(text.error());
  if (text->find_first_not_of(" \t\r\n") == std::string::npos)
    return failure(Fault::malformed, "the file is empty; record again");
  const auto format = options.format ? options.format : recognise(*text);
  if (!format) {
    std::string names;
    for (const std::string& name : import_format_names()) names += (names.empty() ? "" : ", ") + name;
    return failure(Fault::malformed,
                   "not a recording that this program knows; name its format with --from (" + names + ")");
  }
  auto recordings = row_of(*format).read(*text, options);
  if (!recordings) return tl::unexpected(printable(recordings.error()));
  return ImportedFile{*format, std::nullopt, std::move(*recordings)};
}

Result<ImportedFile> import_file(const std::filesystem::path& file, const ImportOptions& options) {
  // Pictures are named by a folder or a pattern, which no other format is.
  const bool several = names_several(file) && (!options.format || options.format == ImportFormat::images);
  const auto pictures = [&]() -> Result<ImportedFile> {
    auto recordings = one(import_images(file, options.rate_hz.value_or(default_picture_rate_hz)));
    if (!recordings) return tl::unexpected(recordings.error());
    return ImportedFile{ImportFormat::images, std::nullopt, std::move(*recordings)};
  };
  if (several || options.format == ImportFormat::images) return pictures();
  const auto bytes = read_whole(file);
  if (!bytes) return tl::unexpected(bytes.error());
  if (!options.format && looks_like_picture(*bytes)) return pictures();
  auto imported = import_bytes(*bytes, options);
  if (!imported) return tl::unexpected(at(file, imported.error()));
  if (imported->format == ImportFormat::usbhid_dump) take_page_beside(file, *imported);
  if (imported->format != ImportFormat::evemu) return imported;

  RawRecording& recording = imported->recordings.front();
  if (options.device)
    imported->description = options.device;
  else if (!recording.device)
    imported->description = description_beside(file);
  if (imported->description) {
    auto device = read_description(*imported->description);
    if (!device) return tl::unexpected(device.error());
    recording.device = std::move(*device);
  }
  return imported;
}

}  // namespace fude
