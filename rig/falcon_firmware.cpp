#include "rig/falcon_firmware.h"

#include <filesystem>
#include <fstream>
#include <string>

#include "rig/share_folder.h"

namespace fude {
namespace {

constexpr std::uintmax_t longest = 1 << 20;  // the arm's own memory is far smaller

std::filesystem::path path() { return user_folder() / "falcon-firmware.bin"; }

}  // namespace

std::vector<std::byte> falcon_firmware() {
  std::error_code failed;
  const std::uintmax_t size = std::filesystem::file_size(path(), failed);
  if (failed || size > longest) return {};
  std::vector<std::byte> image(size);
  std::ifstream file(path(), std::ios::binary);
  file.read(reinterpret_cast<char*>(image.data()), static_cast<std::streamsize>(size));
  return file ? image : std::vector<std::byte>();
}

Error no_falcon_firmware() {
  return {Fault::not_found,
          "the Falcon has no firmware since it was switched on; copy the image of Novint's drivers to " +
              path().string() + " and start again"};
}

Error falcon_firmware_refused() {
  return {Fault::unsupported, "the Falcon does not take the firmware in " + path().string() +
                                  "; see that it is Novint's image, and plug the arm in again"};
}

}  // namespace fude
