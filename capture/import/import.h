// From a file of someone else's to raw recordings: finds out the format, unpacks gzip, and looks
// for the description of the device beside a file that lacks one.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "capture/import/recording.h"
#include "signal/result.h"
#include "signal/units.h"

namespace fude {

enum class ImportFormat {
  evemu,
  libinput,
  mypaint_events,
  hid_recorder,
  usbhid_dump,
  joycon_uart,
  imu_csv,
  poses_csv,
  timestamps_csv,
  images,
  svc,
  wacom_ink_csv,
};

// As `--from` names them: "evemu", "mypaint-events" …; none for "auto" and unknown names.
std::optional<ImportFormat> import_format(std::string_view name);
std::string_view name_of(ImportFormat format);
std::vector<std::string> import_format_names();

// By what the (unpacked) bytes say, never by the file's name.
std::optional<ImportFormat> recognise(std::string_view text);

struct ImportOptions {
  std::optional<ImportFormat> format;           // none: recognise
  std::optional<std::filesystem::path> device;  // an evemu description to use
  std::optional<Millimetres> per_pixel;         // none: as the format has it
  std::optional<double> rate_hz;                // of rows without a time, and of pictures
  double metres_per_unit = 1e-3;                // of poses
};

struct ImportedFile {
  ImportFormat format{};
  std::optional<std::filesystem::path> description;  // the file that the device was taken from, if another
  std::vector<RawRecording> recordings;              // one a device
};

// From bytes alone; gzip is unpacked. Errors: malformed or unsupported, one line without the file's
// name, saying what to do.
Result<ImportedFile> import_bytes(std::string_view bytes, const ImportOptions& options);

// `file` may also be a folder or a pattern of pictures. Also reads what describes the device:
// `options.device`, or for evemu the `.desc` beside the file whose stem begins the file's name (the longest
// such stem), for usbhid-dump the index.md beside it. Errors: as above with the path, not_found, no_access.
Result<ImportedFile> import_file(const std::filesystem::path& file, const ImportOptions& options);

}  // namespace fude
