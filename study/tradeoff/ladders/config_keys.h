#pragma once

#include <string>
#include <vector>

#include "canyon/core/config/config.h"

namespace canyon::study {

/// One key of a configuration as it stands.
struct ConfigKey {
  std::string key;                   ///< dotted; of a list's items as "moving[].shape", their defaults
  std::string value;                 ///< as text; of lists empty
  std::vector<std::string> choices;  ///< the names of which it is one; empty: it is no choice
};

/// All keys in their order. Lists that are empty show their items' keys once.
std::vector<ConfigKey> config_keys(const VisitFunction& visit_fields);

template <class T>
std::vector<ConfigKey> config_keys_of(T& config) {
  return config_keys([&config](FieldVisitor& f) { visit(f, config); });
}

/// nullptr if there is none of that name.
const ConfigKey* find_key(const std::vector<ConfigKey>& keys, const std::string& key);

}  // namespace canyon::study
