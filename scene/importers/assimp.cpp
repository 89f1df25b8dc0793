#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/Importer.hpp>
#include <assimp/ProgressHandler.hpp>

#include "core/files.h"
#include "core/progress.h"
#include "scene/importers/importer.h"

namespace canyon::scene {
namespace {

Eigen::Matrix4d transform_of(const aiMatrix4x4& m) {
  Eigen::Matrix4d out;
  out << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, m.d1, m.d2, m.d3, m.d4;
  return out;
}

std::string material_name(const aiScene& scene, unsigned index) {
  return index < scene.mNumMaterials ? scene.mMaterials[index]->GetName().C_Str() : "";
}

void add_node(const aiScene& source, const aiNode& node, const Eigen::Matrix4d& parent, RawScene& out) {
  const Eigen::Matrix4d placed = parent * transform_of(node.mTransformation);
  if (node.mNumMeshes > 0) {
    const std::string name = node.mName.length > 0 ? node.mName.C_Str() : "mesh";
    const std::uint32_t object = out.add_object(name, kind_by_name(name, ObjectKind::kOther));
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
      const aiMesh& mesh = *source.mMeshes[node.mMeshes[i]];
      throw_if_cancelled();
      RawMesh raw;
      for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
        const Eigen::Vector4d p(mesh.mVertices[v].x, mesh.mVertices[v].y, mesh.mVertices[v].z, 1.0);
        raw.vertices.push_back((placed * p).head<3>());
      }
      const std::uint32_t material = out.material(material_name(source, mesh.mMaterialIndex));
      for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
        if (mesh.mFaces[f].mNumIndices != 3) continue;  // points and lines
        raw.triangles.push_back({mesh.mFaces[f].mIndices[0], mesh.mFaces[f].mIndices[1], mesh.mFaces[f].mIndices[2]});
        raw.object.push_back(object);
        raw.material.push_back(material);
      }
      out.meshes.push_back(std::move(raw));
    }
  }
  for (unsigned i = 0; i < node.mNumChildren; ++i) add_node(source, *node.mChildren[i], placed, out);
}

/// assimp asks between its stages, and between the pieces of some formats.
class StopWhenAsked : public Assimp::ProgressHandler {
 public:
  bool Update(float) override { return !cancel_requested(); }
};

}  // namespace

Result<RawScene> read_with_assimp(const std::string& path, const ReadOptions&) {
  CANYON_TRY_STATUS(read_text_file(path));  // a file that is not there is told as everywhere else
  Assimp::Importer importer;
  importer.SetProgressHandler(new StopWhenAsked);  // the importer's own from here on
  const aiScene* source = importer.ReadFile(path, aiProcess_Triangulate | aiProcess_ValidateDataStructure);
  throw_if_cancelled();
  if (source == nullptr || source->mRootNode == nullptr)
    return Error{path, 0, "", std::string("cannot be read (") + importer.GetErrorString() + ")", "a mesh file"};
  RawScene out;
  out.y_up = path.ends_with(".gltf") || path.ends_with(".glb");
  add_node(*source, *source->mRootNode, Eigen::Matrix4d::Identity(), out);
  if (out.meshes.empty()) return Error{path, 0, "", "holds no mesh", "a mesh file"};
  return out;
}

}  // namespace canyon::scene
