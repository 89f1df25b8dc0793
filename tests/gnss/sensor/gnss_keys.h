#pragma once

#include <string>

#include <gtest/gtest.h>

#include "canyon/gnss/sensor/gnss_config.h"

namespace canyon::gnss::testing {

/// Lays keys of [gnss] over a configuration, as a mission file does: parameters that only a model's own file knows.
inline void set_keys(GnssConfig& config, const std::string& toml) {
  const auto node = ConfigNode::parse(toml, "keys.toml");
  ASSERT_TRUE(node.ok()) << node.error().str();
  const Status status = read_config(&*node, "gnss", config);
  ASSERT_TRUE(status.ok()) << status.error().str();
}

}  // namespace canyon::gnss::testing
