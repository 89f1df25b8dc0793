#include "canyon/scene/written_scene.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>

#include <nlohmann/json.hpp>

#include "canyon/core/config/text.h"
#include "canyon/core/files/files.h"
#include "canyon/core/files/json_text.h"
#include "canyon/core/output/json.h"
#include "canyon/core/process/progress.h"
#include "canyon/scene/importers/far_points.h"
#include "canyon/scene/importers/importer.h"

namespace canyon::scene {
namespace {

constexpr const char* kKinds[] = {"terrain", "building", "vehicle", "tree", "wall", "pole", "other", "person"};

Json point(const Eigen::Vector2d& p) {
  return {p.x(), p.y()};
}
Json point(const Eigen::Vector3d& p) {
  return {p.x(), p.y(), p.z()};
}
Json ring(const std::vector<Eigen::Vector2d>& corners) {
  Json out = Json::array();
  for (const auto& p : corners) out.push_back(point(p));
  return out;
}

Json scene_json(const SceneParts& parts) {
  Json out{{"canyon_scene", 1}, {"name", parts.name}};
  const Geodetic& origin = parts.frame.origin();
  out["origin"] = {{"lat_rad", origin.lat_rad}, {"lon_rad", origin.lon_rad}, {"h_m", origin.h_m}};
  out["undulation_m"] = parts.undulation_m;
  for (const char* key : {"objects", "buildings", "crowns"}) out[key] = Json::array();
  for (const SceneObject& o : parts.objects)
    out["objects"].push_back({{"name", o.name}, {"kind", kKinds[static_cast<std::size_t>(o.kind)]}});
  for (const Building& b : parts.buildings) {
    Json yards = Json::array();
    for (const auto& yard : b.courtyards_W) yards.push_back(ring(yard));
    out["buildings"].push_back({{"name", b.name},
                                {"object", b.object},
                                {"base_m", b.base_m},
                                {"height_m", b.height_m},
                                {"footprint", ring(b.footprint_W)},
                                {"courtyards", yards}});
  }
  for (const Foliage& f : parts.foliage)
    out["crowns"].push_back(
        {{"center", point(f.center_W)}, {"radii_m", point(f.radii_m)}, {"leaf_density_m2_m3", f.leaf_density_m2_m3}});
  out["streets"] = {{"nodes", ring(parts.streets.nodes_W)}, {"edges", Json::array()}};
  for (const auto& e : parts.streets.edges)
    out["streets"]["edges"].push_back({{"a", e.a}, {"b", e.b}, {"width_m", e.width_m}});
  return out;
}

std::string obj_text(const SceneParts& parts) {
  const Mesh& mesh = parts.mesh;
  std::string out =
      "# metres, x east, y north, z up; scene.json beside it tells where on the Earth\nmtllib scene.mtl\n";
  char line[160];
  for (const Eigen::Vector3f& v : mesh.vertices) {
    throw_if_cancelled();
    const int n = std::snprintf(line, sizeof line, "v %.9g %.9g %.9g\n", double{v.x()}, double{v.y()}, double{v.z()});
    out.append(line, static_cast<std::size_t>(n));
  }
  std::uint32_t object = 0xffffffffu, material = 0xffffffffu;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    throw_if_cancelled();
    if (mesh.object[i] != object) out += "o " + parts.objects[object = mesh.object[i]].name + "\n";
    if (mesh.material[i] != material) out += "usemtl " + parts.materials[material = mesh.material[i]].name + "\n";
    const auto& t = mesh.triangles[i];
    const int n = std::snprintf(line, sizeof line, "f %u %u %u\n", t[0] + 1, t[1] + 1, t[2] + 1);
    out.append(line, static_cast<std::size_t>(n));
  }
  return out;
}

/// Only names and a shade of grey by the reflectance at 905 nm, for programs that draw.
std::string mtl_text(const std::vector<Material>& materials) {
  std::string out;
  for (const Material& m : materials) {
    const std::string grey = number_text(m.lidar_reflectance);
    out += "newmtl " + m.name + "\nKd " + grey + " " + grey + " " + grey + "\n";
  }
  return out;
}

std::string materials_text(const std::vector<Material>& materials) {
  std::string out;
  for (const Material& m : materials) {
    const auto line = [&](const char* key, double value) {
      out += std::string(key) + " = " + number_text(value) + "\n";
    };
    out += "[[material]]\nname = " + json_text(Json(m.name)) + "\nitu = [" + number_text(m.itu_a) + ", " +
           number_text(m.itu_b) + ", " + number_text(m.itu_c) + ", " + number_text(m.itu_d) + "]\n";
    out += std::string("rf_absorbing = ") + (m.rf_absorbing ? "true" : "false") + "\n";
    line("thickness_m", m.thickness_m);
    line("roughness_m", m.roughness_m);
    line("scatter_coefficient", m.scatter_coefficient);
    line("scatter_lobe", m.scatter_lobe);
    line("lidar_reflectance", m.lidar_reflectance);
    line("lidar_reflectance_850", m.reflectance(850.0));
    line("lidar_reflectance_1550", m.reflectance(1550.0));
    line("lidar_slope_deg", m.lidar_slope_deg);
    line("lidar_spread", m.lidar_spread);
    line("lidar_grain_m", m.lidar_grain_m);
    line("lidar_specular", m.lidar_specular);
    line("lidar_specular_lobe_deg", m.lidar_specular_lobe_deg);
    line("lidar_retro_1_sr", m.lidar_retro_1_sr);
    line("lidar_transmittance", m.lidar_transmittance);
    out += "source = " + json_text(Json(m.source)) + "\n\n";
  }
  return out;
}

Eigen::Vector2d point2(const nlohmann::json& p) {
  return {p.at(0).get<double>(), p.at(1).get<double>()};
}
Eigen::Vector3d point3(const nlohmann::json& p) {
  return {p.at(0).get<double>(), p.at(1).get<double>(), p.at(2).get<double>()};
}
std::vector<Eigen::Vector2d> ring_of(const nlohmann::json& list) {
  std::vector<Eigen::Vector2d> out;
  for (const auto& p : list) out.push_back(point2(p));
  return out;
}

/// Throws nlohmann's exceptions where something is missing or of another type.
void fill(const nlohmann::json& in, SceneParts& parts) {
  parts.name = in.at("name").get<std::string>();
  const auto& origin = in.at("origin");
  parts.frame = LocalFrame(
      {origin.at("lat_rad").get<double>(), origin.at("lon_rad").get<double>(), origin.at("h_m").get<double>()});
  parts.undulation_m = in.at("undulation_m").get<double>();
  for (const auto& o : in.at("objects")) {
    const std::string kind = o.at("kind").get<std::string>();
    const auto row = std::find(std::begin(kKinds), std::end(kKinds), kind);
    parts.objects.push_back({o.at("name").get<std::string>(), row == std::end(kKinds)
                                                                  ? ObjectKind::kOther
                                                                  : static_cast<ObjectKind>(row - std::begin(kKinds))});
  }
  for (const auto& b : in.at("buildings")) {
    Building building{b.at("name").get<std::string>(), b.at("object").get<std::uint32_t>(),
                      ring_of(b.at("footprint")),      {},
                      b.at("base_m").get<double>(),    b.at("height_m").get<double>()};
    for (const auto& yard : b.at("courtyards")) building.courtyards_W.push_back(ring_of(yard));
    parts.buildings.push_back(std::move(building));
  }
  for (const auto& f : in.at("crowns"))
    parts.foliage.push_back(
        {point3(f.at("center")), point3(f.at("radii_m")), f.at("leaf_density_m2_m3").get<double>()});
  parts.streets.nodes_W = ring_of(in.at("streets").at("nodes"));
  for (const auto& e : in.at("streets").at("edges"))
    parts.streets.edges.push_back(
        {e.at("a").get<std::uint32_t>(), e.at("b").get<std::uint32_t>(), e.at("width_m").get<double>()});
}

}  // namespace

Status write_scene(const SceneParts& parts, const std::string& directory) {
  CANYON_TRY_STATUS(write_text_file(directory + "/scene.obj", obj_text(parts)));
  CANYON_TRY_STATUS(write_text_file(directory + "/scene.mtl", mtl_text(parts.materials)));
  CANYON_TRY_STATUS(write_text_file(directory + "/materials.toml", materials_text(parts.materials)));
  return write_text_file(directory + "/scene.json", json_text(scene_json(parts), 1) + "\n");
}

bool is_written_scene(std::string_view beginning) {
  return beginning.find("\"canyon_scene\"") != std::string_view::npos;
}

Result<SceneParts> read_written_scene(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  const auto beside = [&](const char* name) { return folder.empty() ? std::string(name) : folder + "/" + name; };
  CANYON_TRY(const std::string text, read_text_file(path));
  CANYON_TRY(const nlohmann::json document, parse_json(text, path));
  SceneParts parts;
  try {
    fill(document, parts);
  } catch (const nlohmann::json::exception&) {
    return Error{path, 0, "", "something is missing or of another kind", "a scene.json as canyon scene make writes it"};
  }
  CANYON_TRY(const std::string table, read_text_file(beside("materials.toml")));
  CANYON_TRY(parts.materials, parse_materials(table, beside("materials.toml")));
  std::vector<RawScene> read(1);
  CANYON_TRY(read[0], read_obj(beside("scene.obj"), {}));
  RawScene& raw = read[0];
  raw.files[0] = beside("scene.obj");
  CANYON_TRY_STATUS(refuse_far_points(read));

  std::map<std::string, std::uint32_t> objects, materials;
  for (std::uint32_t i = 0; i < parts.objects.size(); ++i) objects.try_emplace(parts.objects[i].name, i);
  for (std::uint32_t i = 0; i < parts.materials.size(); ++i) materials.try_emplace(parts.materials[i].name, i);
  const RawMesh& mesh = raw.meshes[0];
  for (const Eigen::Vector3d& p : mesh.vertices) parts.mesh.vertices.push_back(p.cast<float>());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    throw_if_cancelled();
    const auto object = objects.find(raw.objects[mesh.object[i]].name);
    const auto material = materials.find(raw.materials[mesh.material[i]]);
    if (object == objects.end())
      return Error{beside("scene.obj"), 0, "o", "\"" + raw.objects[mesh.object[i]].name + "\" is not in scene.json",
                   "an object of it"};
    if (material == materials.end())
      return Error{beside("scene.obj"), 0, "usemtl",
                   "\"" + raw.materials[mesh.material[i]] + "\" is not in materials.toml", "a material of it"};
    parts.mesh.triangles.push_back(mesh.triangles[i]);
    parts.mesh.object.push_back(object->second);
    parts.mesh.material.push_back(static_cast<std::uint16_t>(material->second));
  }
  for (const auto& e : parts.streets.edges)
    if (e.a >= parts.streets.nodes_W.size() || e.b >= parts.streets.nodes_W.size())
      return Error{path, 0, "streets", "an edge to a node that does not exist", "nodes of the list"};
  for (const Building& b : parts.buildings)
    if (b.object >= parts.objects.size())
      return Error{path, 0, "buildings", "an object that does not exist", "an object of the list"};
  return parts;
}

}  // namespace canyon::scene
