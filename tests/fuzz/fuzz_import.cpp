// Any bytes through every importer: a recording or one line of complaint, and time never goes back.
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "capture/import/import.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace fude;
  const std::string_view text(reinterpret_cast<const char*>(bytes), size);
  const auto sound = [](const Result<ImportedFile>& imported) {
    if (!imported) {
      if (imported.error().message.empty()) __builtin_trap();
      return;
    }
    for (const RawRecording& recording : imported->recordings) {
      Timestamp before{};
      for (const Transfer& transfer : recording.transfers) {
        if (transfer.time < before || !unpack_events(transfer.payload)) __builtin_trap();
        before = transfer.time;
      }
    }
  };
  ImportOptions options;
  sound(import_bytes(text, options));
  for (const ImportFormat format :
       {ImportFormat::evemu, ImportFormat::libinput, ImportFormat::mypaint_events}) {
    options.format = format;
    sound(import_bytes(text, options));
  }
  return 0;
}
