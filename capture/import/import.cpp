#include "capture/import/import.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>
#include <system_error>
#include <utility>

#include "capture/import/evemu.h"
#include "capture/import/gzip.h"
#include "capture/import/libinput_record.h"

namespace fude {
namespace {

struct Named {
  ImportFormat format;
  std::string_view name;
};
constexpr std::array<Named, 3> names{{{ImportFormat::evemu, "evemu"},
                                      {ImportFormat::libinput, "libinput"},
                                      {ImportFormat::mypaint_events, "mypaint-events"}}};

Error at(const std::filesystem::path& file, Error error) {
  error.message = file.string() + ": " + error.message;
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

}  // namespace

std::optional<ImportFormat> import_format(std::string_view name) {
  for (const Named& n : names)
    if (n.name == name) return n.format;
  return std::nullopt;
}

std::string_view name_of(ImportFormat format) {
  for (const Named& n : names)
    if (n.format == format) return n.name;
  return {};
}

std::optional<ImportFormat> recognise(std::string_view text) {
  if (looks_like_evemu(text)) return ImportFormat::evemu;
  if (looks_like_libinput_record(text)) return ImportFormat::libinput;
  if (looks_like_mypaint_events(text)) return ImportFormat::mypaint_events;
  return std::nullopt;
}

Result<ImportedFile> import_bytes(std::string_view bytes, const ImportOptions& options) {
  const auto text = unpacked(bytes);
  if (!text) return tl::unexpected(text.error());
  const auto format = options.format ? options.format : recognise(*text);
  if (text->find_first_not_of(" \t\r\n") == std::string::npos)
    return failure(Fault::malformed, "the file is empty; record again");
  if (!format)
    return failure(Fault::malformed,
                   "not a recording that this program knows; name its format with --from (evemu, libinput, "
                   "mypaint-events)");
  ImportedFile imported{.format = *format, .description = std::nullopt, .recordings = {}};
  if (format == ImportFormat::libinput) {
    auto recordings = import_libinput_record(*text);
    if (!recordings) return tl::unexpected(recordings.error());
    imported.recordings = std::move(*recordings);
  } else {
    auto recording =
        format == ImportFormat::evemu ? import_evemu(*text) : import_mypaint_events(*text, options.per_pixel);
    if (!recording) return tl::unexpected(recording.error());
    imported.recordings.push_back(std::move(*recording));
  }
  return imported;
}

Result<ImportedFile> import_file(const std::filesystem::path& file, const ImportOptions& options) {
  const auto bytes = read_whole(file);
  if (!bytes) return tl::unexpected(bytes.error());
  auto imported = import_bytes(*bytes, options);
  if (!imported) return tl::unexpected(at(file, imported.error()));
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
