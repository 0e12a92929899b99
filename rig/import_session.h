// Someone else's recording becomes a session: raw events are kept as they came and run through the
// real driver's decoding.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "capture/import/import.h"
#include "capture/session.h"
#include "signal/action.h"
#include "signal/result.h"

namespace fude {

// What came in and what became of it; nothing is lost without a count.
struct ImportedStream {
  std::string device;  // empty where no description was found
  std::uint64_t events = 0;
  std::uint64_t frames = 0;
  std::uint64_t samples = 0;
  std::uint64_t strokes = 0;
  std::uint64_t lost = 0;
  std::uint64_t out_of_range = 0;
  bool pen = false;       // strokes and the range mean something
  bool raw_only = false;  // no description, or no driver: what came is kept but not decoded
  std::map<std::string, std::uint64_t> passed_over;  // what could not be understood, and how often
};

struct ImportReceipt {
  ImportFormat format{};
  std::vector<ImportedStream> streams;
};

// Writes recordings, what the painter did and how things stood (`settings`), as one session: it appears whole
// or not at all.
// Errors: exists where `session` may not be replaced; no_access; storage.
Result<std::vector<ImportedStream>> write_recordings(std::span<const RawRecording> recordings,
                                                     std::span<const Action> actions,
                                                     const std::string& origin,
                                                     const std::filesystem::path& session, bool overwrite,
                                                     const std::map<std::string, std::string>& settings = {});

struct ImportWish {
  ImportOptions options;
  bool overwrite = false;
};

// Errors: those of import_file and of write_recordings.
Result<ImportReceipt> import_session(const std::filesystem::path& file, const std::filesystem::path& session,
                                     const ImportWish& wish);

}  // namespace fude
