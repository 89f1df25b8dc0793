#include "scene/material.h"

#include <cmath>

#include "core/config.h"
#include "core/embedded.h"

namespace canyon::scene {
namespace {

struct MaterialFile {
  std::vector<Material> materials;
};

}  // namespace

void visit(FieldVisitor& f, Material& m) {
  f.text("name", m.name, "name that meshes refer to");
  std::vector<double> itu{m.itu_a, m.itu_b, m.itu_c, m.itu_d};
  f.numbers("itu", itu, 4, {-10.0, 1e9},
            "ITU-R P.2040-3 a, b, c, d: permittivity a f^b, conductivity c f^d S/m, f in GHz");
  m.itu_a = itu[0], m.itu_b = itu[1], m.itu_c = itu[2], m.itu_d = itu[3];
  f.flag("rf_absorbing", m.rf_absorbing, "blocks radio and reflects none");
  f.number("lidar_reflectance", m.lidar_reflectance, {0.0, 1.0}, "diffuse reflectance at 905 nm");
  f.text("source", m.source, "where the figures come from");
}

namespace {

void visit(FieldVisitor& f, MaterialFile& file) {
  f.list("material", file.materials, "one surface");
}

}  // namespace

std::complex<double> Material::permittivity(double frequency_hz) const {
  CANYON_CHECK(frequency_hz > 0.0, "frequency_hz = ", frequency_hz);
  const double f_ghz = frequency_hz * 1e-9;
  const double conductivity_s_per_m = itu_c * std::pow(f_ghz, itu_d);
  return {itu_a * std::pow(f_ghz, itu_b), -17.98 * conductivity_s_per_m / f_ghz};
}

Result<std::vector<Material>> parse_materials(std::string_view toml, const std::string& file_name) {
  CANYON_TRY(const ConfigNode root, ConfigNode::parse(toml, file_name));
  MaterialFile file;
  CANYON_TRY_STATUS(read_config(&root, "", file));
  if (file.materials.empty()) return root.error("material", "no material", "at least one [[material]] table");
  const auto& rows = *root.find("material")->array();
  for (std::size_t i = 0; i < file.materials.size(); ++i) {
    const Material& m = file.materials[i];
    const auto mistake = [&](const char* key, std::string what, std::string expected) {
      const ConfigNode* at = rows[i].find(key);
      return (at ? *at : rows[i])
          .error(join_values("material[", i + 1, "].", key), std::move(what), std::move(expected));
    };
    if (m.name.empty()) return mistake("name", "missing", "a name");
    if (!(m.itu_a >= 1.0)) return mistake("itu", join_values("a = ", m.itu_a), "a permittivity of at least 1");
    if (!(m.itu_c >= 0.0)) return mistake("itu", join_values("c = ", m.itu_c), "a conductivity of at least 0");
    for (std::size_t j = 0; j < i; ++j) {
      if (file.materials[j].name == m.name) return mistake("name", "\"" + m.name + "\" appears twice", "unique names");
    }
  }
  return std::move(file.materials);
}

const std::vector<Material>& builtin_materials() {
  static const std::vector<Material> materials = [] {
    const auto text = embedded_file("scene/materials.toml");
    CANYON_CHECK(text.has_value(), "scene/materials.toml is not embedded");
    auto parsed = parse_materials(*text, "scene/materials.toml");
    CANYON_CHECK(parsed.ok(), parsed.error().str());
    return *std::move(parsed);
  }();
  return materials;
}

}  // namespace canyon::scene
