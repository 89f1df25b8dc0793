#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/Importer.hpp>

#include <cstring>
#include <type_traits>

#include "canyon/core/files/files.h"
#include "canyon/scene/importers/assimp_part.h"
#include "canyon/scene/importers/importer.h"
#include "canyon/scene/importers/parsing/own_process.h"

namespace canyon::scene {
namespace {

/// A mesh of a node, set into the file's coordinates.
struct PlacedMesh {
  std::string object, material;
  bool new_object = false;  ///< the first of its node
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

Eigen::Matrix4d transform_of(const aiMatrix4x4& m) {
  Eigen::Matrix4d out;
  out << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, m.d1, m.d2, m.d3, m.d4;
  return out;
}

std::string material_name(const aiScene& scene, unsigned index) {
  return index < scene.mNumMaterials ? scene.mMaterials[index]->GetName().C_Str() : "";
}

void add_node(const aiScene& source, const aiNode& node, const Eigen::Matrix4d& parent, std::vector<PlacedMesh>& out) {
  const Eigen::Matrix4d placed = parent * transform_of(node.mTransformation);
  for (unsigned i = 0; i < node.mNumMeshes; ++i) {
    const aiMesh& mesh = *source.mMeshes[node.mMeshes[i]];
    PlacedMesh made{node.mName.length > 0 ? node.mName.C_Str() : "mesh",
                    material_name(source, mesh.mMaterialIndex),
                    i == 0,
                    {},
                    {}};
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
      const Eigen::Vector4d p(mesh.mVertices[v].x, mesh.mVertices[v].y, mesh.mVertices[v].z, 1.0);
      made.vertices.push_back((placed * p).head<3>());
    }
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      if (mesh.mFaces[f].mNumIndices != 3) continue;  // points and lines
      made.triangles.push_back({mesh.mFaces[f].mIndices[0], mesh.mFaces[f].mIndices[1], mesh.mFaces[f].mIndices[2]});
    }
    out.push_back(std::move(made));
  }
  for (unsigned i = 0; i < node.mNumChildren; ++i) add_node(source, *node.mChildren[i], placed, out);
}

Result<std::vector<PlacedMesh>> meshes_of(const std::string& path) {
  Assimp::Importer importer;
  const aiScene* source = importer.ReadFile(path, aiProcess_Triangulate | aiProcess_ValidateDataStructure);
  if (source == nullptr || source->mRootNode == nullptr)
    return Error{path, 0, "", std::string("cannot be read (") + importer.GetErrorString() + ")", "a mesh file"};
  std::vector<PlacedMesh> out;
  add_node(*source, *source->mRootNode, Eigen::Matrix4d::Identity(), out);
  return out;
}

/// From one process to the other: numbers as they lie in memory, lists after their lengths.
class Packer {
 public:
  template <class T>
  void add(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  template <class List>
  void add_list(const List& list) {
    add(list.size());
    bytes.append(reinterpret_cast<const char*>(list.data()), list.size() * sizeof list[0]);
  }
  std::string bytes;
};

class Unpacker {
 public:
  explicit Unpacker(const std::string& bytes) : bytes_(bytes) {}
  template <class T>
  T get() {
    T value;
    copy(&value, sizeof value);
    return value;
  }
  template <class List>
  List list() {
    List out(get<std::size_t>(), typename List::value_type{});
    copy(out.data(), out.size() * sizeof out[0]);
    return out;
  }
  bool at_end() const { return at_ == bytes_.size(); }

 private:
  void copy(void* to, std::size_t count) {
    CANYON_CHECK(count <= bytes_.size() - at_, "count = ", count);
    if (count > 0) std::memcpy(to, bytes_.data() + at_, count);
    at_ += count;
  }
  const std::string& bytes_;
  std::size_t at_ = 0;
};

std::string packed(const std::vector<PlacedMesh>& meshes) {
  Packer out;
  for (const PlacedMesh& mesh : meshes) {
    out.add_list(mesh.object);
    out.add_list(mesh.material);
    out.add(mesh.new_object);
    out.add(mesh.vertices.size());
    for (const Eigen::Vector3d& v : mesh.vertices) out.add(std::array{v.x(), v.y(), v.z()});
    out.add_list(mesh.triangles);
  }
  return std::move(out.bytes);
}

PlacedMesh unpacked(Unpacker& in) {
  PlacedMesh mesh;
  mesh.object = in.list<std::string>();
  mesh.material = in.list<std::string>();
  mesh.new_object = in.get<bool>();
  mesh.vertices.resize(in.get<std::size_t>());
  for (Eigen::Vector3d& v : mesh.vertices) {
    const auto xyz = in.get<std::array<double, 3>>();
    v = {xyz[0], xyz[1], xyz[2]};
  }
  mesh.triangles = in.list<std::vector<std::array<std::uint32_t, 3>>>();
  return mesh;
}

void add(PlacedMesh mesh, RawScene& out) {
  if (mesh.new_object) out.add_object(mesh.object, kind_by_name(mesh.object, ObjectKind::kOther));
  RawMesh raw;
  raw.vertices = std::move(mesh.vertices);
  raw.triangles = std::move(mesh.triangles);
  raw.object.assign(raw.triangles.size(), static_cast<std::uint32_t>(out.objects.size() - 1));
  raw.material.assign(raw.triangles.size(), out.material(mesh.material));
  out.meshes.push_back(std::move(raw));
}

/// assimp follows wild pointers in damaged Collada files and has assertions that end the program: it works in a process
/// of its own.
Result<RawScene> read(const std::string& path) {
  CANYON_TRY_STATUS(read_text_file(path));  // a file that is not there is told as everywhere else
  CANYON_TRY(const std::string bytes, in_a_process_of_its_own(path, [&]() -> Result<std::string> {
               CANYON_TRY(const auto meshes, meshes_of(path));
               return packed(meshes);
             }));
  RawScene out;
  out.y_up = path.ends_with(".gltf") || path.ends_with(".glb");
  for (Unpacker in(bytes); !in.at_end();) add(unpacked(in), out);
  if (out.meshes.empty()) return Error{path, 0, "", "holds no mesh", "a mesh file"};
  return out;
}

}  // namespace

extern "C" const AssimpPart canyon_assimp_part{read};

}  // namespace canyon::scene
