// Where brushes, papers and bundled sessions lie. A user's own folder overrides what came with fude.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "signal/result.h"

namespace fude {

// Looks for `kind`/`name` (kind: "brushes", "papers", "sessions") in $XDG_DATA_HOME/fude, then in
// $FUDE_SHARE, then where fude was built from. A name that is a path to an existing file is that file.
// Errors: not_found, listing the names there are; usage for a name that would leave the folder.
Result<std::filesystem::path> find_shared(const std::string& kind, const std::string& name,
                                          const std::string& extension);

}  // namespace fude
