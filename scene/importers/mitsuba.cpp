#include <algorithm>
#include <filesystem>
#include <map>

#include "canyon/core/process/progress.h"
#include "canyon/scene/importers/importer.h"
#include "canyon/scene/importers/parsing/xml_file.h"

namespace canyon::scene {
namespace {

/// The value of the element <string name="..."> (or any other type) below one.
std::string value_of(const XmlElement& parent, std::string_view name) {
  for (XmlElement e = parent.first_child(); e; e = e.next())
    if (e.attribute("name") == name) return e.attribute("value").value_or("");
  return "";
}

/// Materials by id, of <bsdf> at any depth (Mitsuba wraps them: twosided).
std::map<std::string, std::string> materials_of(const XmlElement& root) {
  std::map<std::string, std::string> out;
  root.walk([&](const XmlElement& e) {
    if (e.name() != "bsdf") return true;
    const std::string id = e.attribute("id").value_or("");
    const bool radio = e.attribute("type") == "itu-radio-material";
    if (!id.empty()) out[id] = radio && !value_of(e, "type").empty() ? value_of(e, "type") : id;
    return true;
  });
  return out;
}

/// "mesh-Arc_de_Triomphe-itu_marble" is a part of the object "Arc_de_Triomphe".
std::string object_of(std::string id) {
  if (id.starts_with("mesh-")) id.erase(0, 5);
  const std::size_t suffix = id.rfind("-itu_");
  return suffix == std::string::npos ? id : id.substr(0, suffix);
}

Status append(RawScene part, std::uint32_t object, std::uint32_t material, RawScene& out) {
  const auto file = static_cast<std::uint32_t>(out.files.size());
  out.files.push_back(part.files[0]);
  for (RawMesh& mesh : part.meshes) {
    mesh.file = file;
    std::fill(mesh.object.begin(), mesh.object.end(), object);
    std::fill(mesh.material.begin(), mesh.material.end(), material);
    out.meshes.push_back(std::move(mesh));
  }
  for (RawPolygon& polygon : part.polygons) {
    polygon.from.file = file;
    polygon.object = object;
    polygon.material = material;
    out.polygons.push_back(std::move(polygon));
  }
  return Ok{};
}

}  // namespace

Result<RawScene> read_mitsuba(const std::string& path, const ReadOptions& options) {
  CANYON_TRY(const XmlFile file, XmlFile::load(path));
  const auto materials = materials_of(file.root());
  RawScene scene;
  std::map<std::string, std::uint32_t> objects;
  std::map<std::string, int> skipped;
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  for (XmlElement shape = file.root().first_child(); shape; shape = shape.next()) {
    throw_if_cancelled();
    if (shape.name() != "shape") continue;
    const std::string type = shape.attribute("type").value_or("");
    if (type != "ply" && type != "obj") {
      ++skipped[type];
      continue;
    }
    if (shape.child("transform")) {
      return Error{path, shape.child("transform").line(), "shape", "a transform", "meshes in the scene's coordinates"};
    }
    const std::string name = value_of(shape, "filename");
    if (name.empty())
      return Error{path, shape.line(), "shape", "no filename", "<string name=\"filename\" value=\"...\"/>"};
    auto part =
        type == "ply" ? read_ply((folder / name).string(), options) : read_obj((folder / name).string(), options);
    if (!part) return part.error();
    part->files[0] = (folder / name).string();

    std::string material;
    for (XmlElement ref = shape.first_child(); ref; ref = ref.next()) {
      if (ref.name() != "ref" && ref.name() != "bsdf") continue;
      const std::string id = ref.attribute("id").value_or("");
      const auto known = materials.find(id);
      if (known == materials.end())
        return Error{path, ref.line(), "ref", "no material \"" + id + "\"", "the id of a <bsdf>"};
      material = known->second;
    }
    const std::string object = object_of(shape.attribute("id").value_or(std::filesystem::path(name).stem().string()));
    const auto [entry, fresh] = objects.try_emplace(object, 0u);
    if (fresh) entry->second = scene.add_object(object, kind_by_name(object, ObjectKind::kBuilding));
    CANYON_TRY_STATUS(append(*std::move(part), entry->second, scene.material(material), scene));
  }
  for (const auto& [type, count] : skipped)
    scene.warnings.push_back(std::to_string(count) + " shapes of type \"" + type + "\" are left out");
  if (scene.objects.empty())
    return Error{path, 0, "", "holds no shape of type ply or obj", "a Mitsuba scene of meshes"};
  return scene;
}

}  // namespace canyon::scene
