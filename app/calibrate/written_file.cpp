#include "app/calibrate/written_file.h"

#include <filesystem>
#include <fstream>

namespace fude {

Result<void> may_write(const std::string& name, bool force) {
  std::error_code ignored;
  if (!name.empty() && !force && std::filesystem::exists(name, ignored))
    return failure(Fault::exists, name + " exists already; choose another name or give --force");
  return {};
}

Result<void> write_file(const std::string& name, const std::string& bytes) {
  if (name.empty()) return {};
  std::ofstream file(name, std::ios::binary);
  file << bytes;
  file.close();
  if (!file) return failure(Fault::storage, name + " cannot be written; check the folder and the disk");
  return {};
}

}  // namespace fude
