#include <algorithm>
#include <charconv>

#include "canyon/core/files/files.h"
#include "canyon/core/files/line_reader.h"
#include "canyon/core/process/progress.h"
#include "canyon/scene/importers/importer.h"

namespace canyon::scene {
namespace {

constexpr const char* kFaceExpected = "f and at least three vertices that exist, as 1, 1/2, 1/2/3 or -1";

/// One OBJ file being read. Vertices keep their order, faces theirs, so that what canyon writes comes back the same.
/// assimp reads OBJ too, but in single precision (half a metre on a national grid), in an order of its own, with
/// mistakes told without their line, and in a process of its own.
class ObjReader {
 public:
  ObjReader(const std::string& path, std::string text) : in_(path, std::move(text)) {}

  Result<RawScene> read() {
    scene_.meshes.emplace_back();
    std::string_view line;
    std::string continued;
    while (in_.next(line)) {
      throw_if_cancelled();
      if (line.back() == '\\') {  // the line goes on
        continued += std::string(line.substr(0, line.size() - 1)) + " ";
        continue;
      }
      if (!continued.empty()) {
        continued += line;
        CANYON_TRY_STATUS(statement(continued));
        continued.clear();
        continue;
      }
      CANYON_TRY_STATUS(statement(line));
    }
    if (scene_.meshes[0].vertices.empty()) return in_.empty_file("vertex");
    if (scene_.meshes[0].triangles.empty() && scene_.polygons.empty()) return in_.empty_file("face");
    return std::move(scene_);
  }

 private:
  Status statement(std::string_view line) {
    const std::vector<std::string_view> words = split(line, " \t", true);
    if (words.empty()) return Ok{};
    if (words[0] == "v") return vertex(words);
    if (words[0] == "f") return face(words);
    if (words[0] == "o" || words[0] == "g") {
      name_ = words.size() > 1 ? std::string(trimmed(line.substr(line.find(words[1])))) : "";
      open_ = false;
    } else if (words[0] == "usemtl") {
      material_ = scene_.material(words.size() > 1 ? std::string(words[1]) : "");
    }
    return Ok{};  // normals, texture, smoothing and lines do not matter here
  }

  Status vertex(const std::vector<std::string_view>& words) {
    if (words.size() < 4) return in_.error("a vertex of " + std::to_string(words.size() - 1) + " numbers", "v x y z");
    Eigen::Vector3d p;
    for (int k = 0; k < 3; ++k) {
      // Not finite numbers are let in: the scene drops and counts the triangles that use them.
      const std::string_view word = words[static_cast<std::size_t>(k) + 1];
      const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), p[k]);
      if (error != std::errc() || end != word.data() + word.size())
        return in_.error("\"" + std::string(word) + "\" is not a number", "v x y z");
    }
    scene_.meshes[0].vertices.push_back(p);
    scene_.meshes[0].line.push_back(static_cast<std::uint32_t>(in_.number()));
    return Ok{};
  }

  Status face(const std::vector<std::string_view>& words) {
    RawMesh& mesh = scene_.meshes[0];
    corners_.clear();
    for (std::size_t i = 1; i < words.size(); ++i) {
      const std::string_view index = words[i].substr(0, words[i].find('/'));
      long long n = 0;
      const auto [end, error] = std::from_chars(index.data(), index.data() + index.size(), n);
      const auto count = static_cast<long long>(mesh.vertices.size());
      if (n < 0) n += count + 1;
      if (error != std::errc() || end != index.data() + index.size() || n < 1 || n > count)
        return in_.error("vertex \"" + std::string(words[i]) + "\" of " + std::to_string(count), kFaceExpected);
      corners_.push_back(static_cast<std::uint32_t>(n - 1));
    }
    if (corners_.size() < 3)
      return in_.error("a face of " + std::to_string(corners_.size()) + " vertices", kFaceExpected);
    const std::uint32_t object = current_object();
    if (corners_.size() == 3) {
      mesh.triangles.push_back({corners_[0], corners_[1], corners_[2]});
      mesh.object.push_back(object);
      mesh.material.push_back(material_);
      return Ok{};
    }
    RawPolygon polygon{.object = object, .material = material_, .rings = {{}}};
    polygon.from.line = static_cast<std::uint32_t>(in_.number());
    for (const std::uint32_t corner : corners_) polygon.rings[0].push_back(mesh.vertices[corner]);
    scene_.polygons.push_back(std::move(polygon));
    return Ok{};
  }

  /// The object of the last o or g; made with its first face, so that empty groups leave no trace.
  std::uint32_t current_object() {
    if (!open_) {
      const std::string name = name_.empty() ? "mesh" : name_;
      object_ = scene_.add_object(name, kind_by_name(name, ObjectKind::kOther));
      open_ = true;
    }
    return object_;
  }

  LineReader in_;
  RawScene scene_;
  std::string name_;
  bool open_ = false;
  std::uint32_t object_ = 0, material_ = 0;
  std::vector<std::uint32_t> corners_;
};

}  // namespace

Result<RawScene> read_obj(const std::string& path, const ReadOptions&) {
  CANYON_TRY(std::string text, read_text_or_gzip_file(path));
  return ObjReader(path, std::move(text)).read();
}

}  // namespace canyon::scene
