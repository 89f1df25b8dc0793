#pragma once

#include <string>

namespace canyon::mission {

/// All keys of a mission file as a Markdown page, docs/mission.md: section, key, unit, default, range, meaning, and
/// what the built-in fidelities lay over them. Made from the functions that read the keys, so that it cannot fall
/// behind.
std::string key_reference();

}  // namespace canyon::mission
