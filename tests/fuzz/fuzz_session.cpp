// Any bytes as a session file: a session or one line of complaint.
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include "capture/session.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace fude;
  static const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("fuzz_session." + std::to_string(getpid()) + ".fude");
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes), static_cast<std::streamsize>(size));
  if (const auto session = read_session(file); !session && session.error().message.empty()) __builtin_trap();
  for (const char* suffix : {"-wal", "-journal", "-shm"}) std::filesystem::remove(file.string() + suffix);
  return 0;
}
