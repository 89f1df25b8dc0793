#pragma once

#include <string>
#include <vector>

#include "canyon/core/config/config.h"

namespace canyon::study {

/// A key of a configuration and what is tried for it, as TOML writes values.
struct SweptKey {
  std::string key;  ///< dotted
  bool numeric = false;
  std::vector<std::string> values;
};

/// Every key with values of its own: of numbers both ends of the range, the decades between them (from 1e-12 to 1e12 in
/// size) and what stands for none; of a list of numbers that has a length, all at the same of these; flags, both; of
/// choices, all. Texts, files and the items of lists are not among them.
std::vector<SweptKey> swept_keys(const VisitFunction& visit_fields);

}  // namespace canyon::study
