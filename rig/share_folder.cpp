#include "rig/share_folder.h"

#include <cstdlib>
#include <fstream>
#include <set>

namespace fude {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> folders() {
  std::vector<fs::path> found;
  if (const fs::path own = user_folder(); !own.empty()) found.push_back(own);
  if (const char* own = std::getenv("FUDE_SHARE"); own && *own) found.emplace_back(own);
  found.emplace_back(FUDE_SHARE_FOLDER);
  return found;
}

}  // namespace

fs::path user_folder() {
  const char* data_home = std::getenv("XDG_DATA_HOME");
  if (data_home && *data_home) return fs::path(data_home) / "fude";
  const char* home = std::getenv("HOME");
  if (home && *home) return fs::path(home) / ".local/share/fude";
  return {};
}

Result<fs::path> find_shared(const std::string& kind, const std::string& name, const std::string& extension) {
  std::error_code ignored;
  if (name.find('/') != std::string::npos || name.ends_with(extension)) {
    if (fs::is_regular_file(name, ignored)) return fs::path(name);
    return failure(Fault::not_found, name + " is not there");
  }
  for (const fs::path& folder : folders()) {
    const fs::path file = folder / kind / (name + extension);
    if (fs::is_regular_file(file, ignored)) return file;
  }
  std::string list;
  for (const std::string& n : shared_names(kind, extension)) list += (list.empty() ? "" : ", ") + n;
  return failure(Fault::not_found, "there is no '" + name + "' among the " + kind +
                                       "; there are: " + (list.empty() ? "none" : list));
}

std::vector<std::string> shared_names(const std::string& kind, const std::string& extension) {
  std::error_code ignored;
  std::set<std::string> names;
  for (const fs::path& folder : folders())
    for (const auto& entry : fs::directory_iterator(folder / kind, ignored))
      if (entry.path().extension() == extension) names.insert(entry.path().stem().string());
  return {names.begin(), names.end()};
}

std::string first_remark(const fs::path& file) {
  std::ifstream in(file);
  std::string line;
  if (!std::getline(in, line) || !line.starts_with("#")) return {};
  const std::size_t text = line.find_first_not_of("# ");
  return text == std::string::npos ? std::string() : line.substr(text);
}

}  // namespace fude
