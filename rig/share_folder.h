// Where brushes, papers and bundled sessions lie. A user's own folder overrides what came with fude.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "signal/result.h"

namespace fude {

// $XDG_DATA_HOME/fude, or where that is not set ~/.local/share/fude; empty without a home.
std::filesystem::path user_folder();

// Looks for `kind`/`name` (kind: "brushes", "papers", "sessions") in user_folder(), then in
// $FUDE_SHARE, then where fude was built from. A name that is a path to an existing file is that file.
// Errors: not_found, listing the names there are; usage for a name that would leave the folder.
Result<std::filesystem::path> find_shared(const std::string& kind, const std::string& name,
                                          const std::string& extension);

// The names there are of a kind, in order, each once.
std::vector<std::string> shared_names(const std::string& kind, const std::string& extension);

// What the first line of a TOML file says after its #; empty where it says nothing.
std::string first_remark(const std::filesystem::path& file);

}  // namespace fude
