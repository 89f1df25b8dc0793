#pragma once

#include <string>

#include "canyon/core/config/config.h"

namespace canyon::stress {

/// Whether a configuration that nothing was said to is this one, as fields_as_json() writes it: every key with its
/// default, in order.
template <class Config>
bool said_nothing(const std::string& expected) {
  Config config;
  return fields_as_json([&config](FieldVisitor& f) { visit(f, config); }) == expected;
}

}  // namespace canyon::stress
