#include "canyon/scene/surfaces/material.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "canyon/core/config/config.h"
#include "canyon/core/config/text.h"
#include "canyon/core/files/files.h"
#include "canyon/core/output/printed.h"
#include "canyon/core/process/embedded.h"

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
  f.number("thickness_m", m.thickness_m, {0.0, 100.0}, "of the slab that radio meets; 0: nothing comes through");
  f.number("roughness_m", m.roughness_m, {0.0, 10.0}, "standard deviation of the surface's height, for radio");
  f.number("scatter_coefficient", m.scatter_coefficient, {0.0, 0.95},
           "of an upright wall: radio field scattered over field given back");
  std::int64_t lobe = m.scatter_lobe;
  f.integer("scatter_lobe", lobe, {1, 20}, "exponent of the lobe that it is scattered into");
  m.scatter_lobe = static_cast<int>(lobe);
  f.number("lidar_reflectance", m.lidar_reflectance, {0.0, 1.0}, "diffuse reflectance at 905 nm");
  const auto other = [&](const char* key, std::optional<double>& value, const char* doc) {
    double filled = value.value_or(m.lidar_reflectance);
    f.number(key, filled, {0.0, 1.0}, doc);
    value = filled;
  };
  other("lidar_reflectance_850", m.lidar_reflectance_850, "diffuse reflectance at 850 nm; else as at 905 nm");
  other("lidar_reflectance_1550", m.lidar_reflectance_1550, "diffuse reflectance at 1550 nm; else as at 905 nm");
  f.number("lidar_slope_deg", m.lidar_slope_deg, {0.0, 60.0},
           "standard deviation of the slope of matt facets, for [lidar] reflection = \"rough\"");
  f.number(
      "lidar_spread", m.lidar_spread, {0.0, 0.3},
      "relative standard deviation of the diffuse reflectance within a surface, for [lidar] brightness = \"varied\"");
  f.number("lidar_grain_m", m.lidar_grain_m, {0.01, 100.0}, "size of its lighter and darker places");
  f.number("lidar_specular", m.lidar_specular, {0.0, 1.0}, "share of the light reflected as by a mirror");
  f.number("lidar_specular_lobe_deg", m.lidar_specular_lobe_deg, {0.001, 45.0},
           "standard deviation of the mirror's slope");
  f.number("lidar_retro_1_sr", m.lidar_retro_1_sr, {0.0, 1e5}, "coefficient of retroreflection R_A, cd/(lx m^2)");
  f.number("lidar_transmittance", m.lidar_transmittance, {0.0, 1.0},
           "share of the light that passes through at normal incidence; less at an angle, as through a pane");
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

double Material::reflectance(double wavelength_nm) const {
  CANYON_CHECK(wavelength_nm > 0.0, "wavelength_nm = ", wavelength_nm);
  const double at_850 = lidar_reflectance_850.value_or(lidar_reflectance);
  const double at_1550 = lidar_reflectance_1550.value_or(lidar_reflectance);
  if (wavelength_nm <= 905.0) {
    const double s = std::clamp((wavelength_nm - 850.0) / (905.0 - 850.0), 0.0, 1.0);
    return at_850 + s * (lidar_reflectance - at_850);
  }
  const double s = std::min((wavelength_nm - 905.0) / (1550.0 - 905.0), 1.0);
  return lidar_reflectance + s * (at_1550 - lidar_reflectance);
}

double Material::widest() const {
  return lidar_spread * std::sqrt(3.0 * 27.0 / 8.0);
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
    const double diffuse =
        std::max({m.lidar_reflectance, m.lidar_reflectance_850.value_or(0.0), m.lidar_reflectance_1550.value_or(0.0)});
    const double share = diffuse + m.lidar_specular + m.lidar_transmittance;
    const double brightest = diffuse * (1.0 + m.widest());
    if (share <= 1.0 + 1e-9 && brightest + m.lidar_specular + m.lidar_transmittance > 1.0 + 1e-9)
      return mistake("lidar_spread",
                     "with " + number_text(m.lidar_spread) + " the brightest place reflects " +
                         printed("%.4f", brightest) + " beside specular " + number_text(m.lidar_specular) +
                         " and transmittance " + number_text(m.lidar_transmittance),
                     "no more light than comes in");
    if (share > 1.0 + 1e-9)
      return mistake("lidar_reflectance",
                     "reflectance " + number_text(diffuse) + ", specular " + number_text(m.lidar_specular) +
                         " and transmittance " + number_text(m.lidar_transmittance) + " make more than 1",
                     "no more light than comes in");
    for (std::size_t j = 0; j < i; ++j) {
      if (file.materials[j].name == m.name) return mistake("name", "\"" + m.name + "\" appears twice", "unique names");
    }
  }
  return std::move(file.materials);
}

Result<std::vector<Material>> load_materials(const std::vector<std::string>& paths) {
  std::vector<Material> table = builtin_materials();
  for (const std::string& path : paths) {
    CANYON_TRY(const std::string text, read_text_file(path));
    CANYON_TRY(const auto rows, parse_materials(text, path));
    for (const Material& row : rows) {
      const auto known =
          std::find_if(table.begin(), table.end(), [&](const Material& m) { return m.name == row.name; });
      if (known == table.end())
        table.push_back(row);
      else
        *known = row;
    }
  }
  if (table.size() > std::numeric_limits<std::uint16_t>::max())
    return Error{"", 0, "materials", std::to_string(table.size()) + " materials", "at most 65535"};
  return table;
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
