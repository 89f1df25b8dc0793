#pragma once

#include <string>

#include <gtest/gtest.h>

#include "canyon/mission/config/mission_file.h"

namespace canyon::mission::testing {

inline MissionFile parse(const std::string& toml) {
  auto file = MissionFile::parse(toml, "my.toml");
  EXPECT_TRUE(file.ok()) << (file.ok() ? "" : file.error().str());
  return *file;
}

/// The message a user sees for a mission file, whichever step finds the mistake.
inline std::string message(const std::string& toml, const std::string& fidelity = "high") {
  auto file = MissionFile::parse(toml, "my.toml");
  if (!file) return file.error().str();
  const auto config = file->resolve(fidelity);
  if (!config) return config.error().str();
  SceneCache scenes;
  const auto mission = prepare(*config, scenes);
  return mission ? "no mistake" : file->locate(mission.error(), fidelity).str();
}

inline constexpr const char* kEmptyScene = "base = \"vicksburg\"\n[scene]\nempty = true\n";

}  // namespace canyon::mission::testing
