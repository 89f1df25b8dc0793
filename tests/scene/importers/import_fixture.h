#pragma once

#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "canyon/core/units.h"
#include "canyon/scene/import.h"
#include "canyon/scene/scene.h"
#include "canyon/tests/support/outside_program.h"

/// Small files of every format, whose content is known: synthetic twins of the real scenes.
namespace canyon::scene::testing {

class Import : public ::testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(scratch_.file(name), std::ios::binary) << text;
    return scratch_.file(name);
  }

  Result<ImportedScene> import(const std::string& path) {
    config_.file = path;
    if (!config_.undulation_m) config_.undulation_m = 40.0;
    return import_scene(config_, {45.0 * kDegree, 5.0 * kDegree, 100.0});
  }

  SceneParts parts(const std::string& name, const std::string& text) {
    auto made = import(write(name, text));
    EXPECT_TRUE(made.ok()) << (made.ok() ? "" : made.error().str());
    if (!made.ok()) return {};
    warnings_ = made->report.warnings;
    return std::move(made->parts);
  }

  /// The error's text without the folder.
  std::string message(const std::string& name, const std::string& text) {
    const auto made = import(write(name, text));
    EXPECT_FALSE(made.ok());
    if (made.ok()) return "";
    std::string out = made.error().str();
    const std::string folder = scratch_.file("");
    for (std::size_t at; (at = out.find(folder)) != std::string::npos;) out.erase(at, folder.size());
    return out;
  }

  canyon::testing::ScratchDirectory scratch_;
  ImportConfig config_;
  std::vector<std::string> warnings_;
};

inline double area_m2(const SceneParts& parts, const std::string& material, double up_at_least = -2.0) {
  double sum = 0.0;
  for (std::size_t i = 0; i < parts.mesh.triangles.size(); ++i) {
    const auto& t = parts.mesh.triangles[i];
    const auto at = [&](std::size_t k) { return parts.mesh.vertices[t[k]].cast<double>(); };
    const Eigen::Vector3d n = 0.5 * (at(1) - at(0)).cross(at(2) - at(0));
    if (parts.materials[parts.mesh.material[i]].name == material && n.z() >= up_at_least * n.norm()) sum += n.norm();
  }
  return sum;
}

// A footprint of about 20 x 20 m with a yard of 10 x 10 m, 12 m high, on ground at 200 m: 1e-4 deg of latitude are 11.1
// m.
inline constexpr const char* kFootprint = R"({"type":"FeatureCollection","features":[{"type":"Feature",
"properties":{"id":"town hall","height":12.0,"ground_height":200.0},"geometry":{"type":"Polygon","coordinates":[
[[5.0,45.0],[5.0003,45.0],[5.0003,45.0002],[5.0,45.0002],[5.0,45.0]],
[[5.0001,45.00005],[5.0002,45.00005],[5.0002,45.00015],[5.0001,45.00015],[5.0001,45.00005]]]}}]})";

}  // namespace canyon::scene::testing
